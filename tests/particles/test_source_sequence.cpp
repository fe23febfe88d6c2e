#include "particles/sequence.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

SequenceParams sequence(const std::string& pattern, int first = 1, int last = 0, int offset = 0,
                        OutsideRange outside = OutsideRange::Hold)
{
    return {pattern, first, last, offset, outside};
}

std::string name_at(const SequenceParams& params, int frame)
{
    const auto path = sequence_path(params, frame, "");
    return path ? *path : "hidden";
}

TEST(Sequence, ExpandsEveryTokenForm)
{
    for (const char* pattern : {"a.####.ply", "a.%04d.ply", "a.$F4.ply"}) {
        EXPECT_EQ(name_at(sequence(pattern, 1, 20000), 7), "a.0007.ply") << pattern;
        EXPECT_EQ(name_at(sequence(pattern, 1, 20000), 12345), "a.12345.ply") << pattern;
    }
    EXPECT_EQ(name_at(sequence("a%d.ply", 1, 99), 7), "a7.ply");
    EXPECT_EQ(name_at(sequence("a$F.ply", 1, 99), 7), "a7.ply");
    EXPECT_EQ(name_at(sequence("a#.ply", 1, 99), 12), "a12.ply");
    EXPECT_EQ(name_at(sequence("a.####.ply", -9, 9), -5), "a.-005.ply");
    EXPECT_EQ(name_at(sequence("100%.ply"), 3), "100%.ply");  // no token: one file
}

TEST(Sequence, OffsetAndWhatLiesOutside)
{
    EXPECT_EQ(name_at(sequence("a##", 1001, 1010, 1000), 5), "a1005");
    EXPECT_EQ(name_at(sequence("a##", 3, 5, 0, OutsideRange::Hold), 1), "a03");
    EXPECT_EQ(name_at(sequence("a##", 3, 5, 0, OutsideRange::Hold), 9), "a05");
    EXPECT_EQ(name_at(sequence("a##", 3, 5, 0, OutsideRange::Hide), 2), "hidden");
    EXPECT_EQ(name_at(sequence("a##", 3, 5, 0, OutsideRange::Hide), 6), "hidden");
    EXPECT_EQ(name_at(sequence("a##", 3, 5, 0, OutsideRange::Loop), 6), "a03");
    EXPECT_EQ(name_at(sequence("a##", 3, 5, 0, OutsideRange::Loop), 2), "a05");
    EXPECT_EQ(name_at(sequence("a##", 3, 5, 0, OutsideRange::Loop), -4), "a05");
    // Far outside: no overflow.
    EXPECT_EQ(name_at(sequence("a##", 3, 5, 2147483647), 2147483647), "a05");
}

TEST(Sequence, RangeIsFoundInTheFolder)
{
    const TemporaryFolder folder;
    for (const char* name : {"s.1001.vdb", "s.1002.vdb", "s.1004.vdb", "s.12.vdb", "s.01005.vdb",
                             "t.2000.vdb", "s.1005.ply", "s.x.vdb"}) {
        folder.write(name, "x");
    }
    const auto range = sequence_range(sequence("s.####.vdb"), folder.path());
    ASSERT_TRUE(range);
    EXPECT_EQ(range->first, 1001);
    EXPECT_EQ(range->last, 1004);
    EXPECT_EQ(resolve_sequence(sequence("s.####.vdb"), 1, folder.path()),
              folder.file("s.1001.vdb"));
    EXPECT_FALSE(sequence_range(sequence("s.1001.vdb"), folder.path()));
}

TEST(Sequence, EveryErrorNamesTheFile)
{
    const TemporaryFolder folder;
    folder.write("s.0001.vdb", "x");
    folder.write("s.0003.vdb", "x");
    EXPECT_EQ(
        error_message([&] { (void)resolve_sequence(sequence("s.####.vdb"), 2, folder.path()); }),
        folder.file("s.0002.vdb") +
            ": missing from the sequence of frames 1 to 3 (scene frame 2); write the file or "
            "set `first` and `last`");
    EXPECT_EQ(
        error_message([&] { (void)resolve_sequence(sequence("t.vdb"), 2, folder.path()); }),
        folder.file("t.vdb") + ": no such file; relative paths start at the scene file's folder");
    EXPECT_EQ(error_message([&] { (void)sequence_path(sequence("t.##.vdb"), 2, folder.path()); }),
              folder.file("t.##.vdb") +
                  ": no file of this sequence from frame 1 on; check the path, the padding and "
                  "`first`");
    EXPECT_EQ(error_message([&] { (void)sequence_path(sequence("no/t.##"), 2, folder.path()); }),
              folder.file("no") + ": cannot read the folder: No such file or directory");
    EXPECT_EQ(error_message([&] { (void)sequence_path(sequence("a_##/b_##", 1, 2), 1, ""); }),
              "a_##/b_##: one frame token only, and in the file name, not the folder");
    EXPECT_EQ(error_message([&] { (void)sequence_path(sequence("a/"), 1, ""); }),
              "\"a/\" is not a file name or sequence pattern");
    EXPECT_EQ(error_message([&] { (void)resolve_sequence(sequence("."), 1, folder.path()); }),
              folder.file(".") + ": not a regular file");
}

}  // namespace
}  // namespace mote
