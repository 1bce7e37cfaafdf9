// ctest labels: unit
#include "core/base/file_stamp.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "tests/support/temp_dir.h"

namespace uw {
namespace {

namespace fs = std::filesystem;

TEST(FileStamp, ChangesWithAllThatTellsFilesApart) {
    const test::TempDir folder;
    const fs::path file = folder / "a";
    const auto write = [](const fs::path& to, const char* text) { std::ofstream(to) << text; };
    EXPECT_FALSE(stamp_of(file));
    write(file, "one");
    const fs::file_time_type time = fs::last_write_time(file);
    const auto first = stamp_of(file);
    ASSERT_TRUE(first);
    EXPECT_EQ(stamp_of(file), first);
    fs::create_symlink(file, folder / "link");
    EXPECT_EQ(stamp_of(folder / "link"), first);

    write(file, "longer");  // of the same time
    fs::last_write_time(file, time);
    EXPECT_NE(stamp_of(file), first);
    write(file, "one");
    fs::last_write_time(file, time + std::chrono::nanoseconds(1));
    EXPECT_NE(stamp_of(file), first);
    write(folder / "b", "one");  // another file in its place
    fs::last_write_time(folder / "b", time);
    fs::rename(folder / "b", file);
    EXPECT_NE(stamp_of(file), first);
}

}  // namespace
}  // namespace uw
