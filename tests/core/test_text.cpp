#include <gtest/gtest.h>

#include <vector>

#include "core/text.h"

namespace mote {
namespace {

TEST(Text, SuggestsTheNearestName)
{
    const std::vector<std::string> known{"density", "albedo", "phase"};
    EXPECT_EQ(did_you_mean("densty", known), " (did you mean \"density\"?)");
    EXPECT_EQ(did_you_mean("abledo", known), " (did you mean \"albedo\"?)");
    EXPECT_EQ(did_you_mean("resolution", known), "");
}

TEST(Text, MakesHostileTextPrintable)
{
    EXPECT_EQ(printable("a\nb\x1b[0m"), "a?b?[0m");
    EXPECT_EQ(printable("a\x7f"
                        "b\xc2\x9b"
                        "31m"),
              "a?b?31m");  // U+009B starts escapes, as ESC [ does
    EXPECT_EQ(printable(std::string(300, 'x'), 10), "xxxxxxxxxx...");
    EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a?b");
    EXPECT_EQ(printable(""), "");
}

TEST(Text, KeepsCharactersOfAllLanguages)
{
    for (const char* text : {"na\xc3\xafve", "\xc2\xa0", "\xe7\x85\x99", "\xef\xbf\xbd",
                             "\xed\x9f\xbf", "\xf0\x9f\x8c\xab", "\xf4\x8f\xbf\xbf"}) {
        EXPECT_EQ(printable(text), text);
    }
}

TEST(Text, BytesThatAreNoUtf8AreReplaced)
{
    EXPECT_EQ(printable("\xff\xfe"), "??");
    EXPECT_EQ(printable("\x80x\xbf"), "?x?");           // continuation without a lead
    EXPECT_EQ(printable("\xc0\xaf"), "??");             // overlong "/"
    EXPECT_EQ(printable("\xe0\x80\xaf"), "???");        // the same in three bytes
    EXPECT_EQ(printable("\xf0\x8f\xbf\xbf"), "????");   // and in four
    EXPECT_EQ(printable("\xed\xa0\x80"), "???");        // half of a surrogate pair
    EXPECT_EQ(printable("\xf4\x90\x80\x80"), "????");   // above U+10FFFF
    EXPECT_EQ(printable("\xe7\x85"), "??");             // cut short
    EXPECT_EQ(printable("\xc3\xc3\xa9"), "?\xc3\xa9");  // a good one after a bad one
}

TEST(Text, IsNeverCutWithinACharacter)
{
    EXPECT_EQ(printable("ab\xe7\x85\x99", 5), "ab\xe7\x85\x99");
    EXPECT_EQ(printable("ab\xe7\x85\x99", 4), "ab...");
    EXPECT_EQ(printable("ab\xe7\x85\x99"
                        "c",
                        5),
              "ab\xe7\x85\x99...");
}

TEST(Text, FormatsBytes)
{
    EXPECT_EQ(format_bytes(12), "12 B");
    EXPECT_EQ(format_bytes(1.5e9), "1.5 GB");
}

}  // namespace
}  // namespace mote
