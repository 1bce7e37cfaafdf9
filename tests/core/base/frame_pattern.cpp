// ctest labels: unit
#include "core/base/input_files.h"

#include <gtest/gtest.h>

#include "tests/support/temp_dir.h"

namespace uw {
namespace {

struct Case {
    const char* name;
    const char* frame_7;
    const char* frame_12345;
};

TEST(FramePattern, EveryFormAndItsWidth) {
    for (const Case& c : std::initializer_list<Case>{
             {"a_%d.vdb", "a_7.vdb", "a_12345.vdb"},
             {"a_%04d.vdb", "a_0007.vdb", "a_12345.vdb"},
             {"a_%012d", "a_000000000007", "a_000000012345"},
             {"#", "7", "12345"},
             {"a.####.vdb", "a.0007.vdb", "a.12345.vdb"},
             {"a_######", "a_000007", "a_012345"},
             {"a.$F.vdb", "a.7.vdb", "a.12345.vdb"},
             {"a.$F4.vdb", "a.0007.vdb", "a.12345.vdb"},
             {"$F6", "000007", "012345"},
             {"$F_x", "7_x", "12345_x"},
             {"{frame}.exr", "7.exr", "12345.exr"},
             {"x{frame:04d}.exr", "x0007.exr", "x12345.exr"},
             {"x{frame:06}.exr", "x000007.exr", "x012345.exr"},
             {"x{frame:d}", "x7", "x12345"},
             {"%d/%d_##_$F3_{frame}", "7/7_07_007_7", "12345/12345_12345_12345_12345"},
         }) {
        EXPECT_TRUE(has_frame_pattern(c.name)) << c.name;
        EXPECT_EQ(expand_frame_pattern(c.name, 7), c.frame_7);
        EXPECT_EQ(expand_frame_pattern(c.name, 12345), c.frame_12345);
    }
}

TEST(FramePattern, EverythingElseIsAsItIsWritten) {
    for (const char* name :
         {"",           "plume.vdb", "100%",      "a%",     "a%s",   "%4d",      "%0d",
          "%0123d",     "%5.2d",     "% d",       "$",      "$f",    "$FF",      "$FPS",
          "$Frame",     "$F12",      "$F0",       "${F}",   "{",     "{}",       "{frames}",
          "{frame:4d}", "{frame:",   "{frame:x}", "{frame", "frame", "{ frame }"}) {
        EXPECT_FALSE(has_frame_pattern(name)) << name;
        EXPECT_EQ(expand_frame_pattern(name, 7), name);
    }
}

TEST(FramePattern, FoldersThatExistAsWrittenAreTakenAsWritten) {
    const test::TempDir folder;
    std::filesystem::create_directories(folder / "C#" / "take_%d");
    EXPECT_EQ(file_of_frame(folder / "C#/take_%d/a_##.vdb", 3), folder / "C#/take_%d/a_03.vdb");
    EXPECT_EQ(file_of_frame(folder / "C#/shot_%d/a.vdb", 3), folder / "C#/shot_3/a.vdb");
    EXPECT_EQ(file_of_frame("a_#.vdb", 3), "a_3.vdb");
    EXPECT_EQ(file_of_frame("/", 3), "/");
    EXPECT_TRUE(differs_by_frame(folder / "C#/shot_%d/a.vdb"));
    EXPECT_FALSE(differs_by_frame(folder / "C#/take_%d/a.vdb"));
}

}  // namespace
}  // namespace uw
