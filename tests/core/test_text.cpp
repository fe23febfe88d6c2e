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
    EXPECT_EQ(printable(std::string(300, 'x'), 10), "xxxxxxxxxx...");
}

TEST(Text, FormatsBytes)
{
    EXPECT_EQ(format_bytes(12), "12 B");
    EXPECT_EQ(format_bytes(1.5e9), "1.5 GB");
}

}  // namespace
}  // namespace mote
