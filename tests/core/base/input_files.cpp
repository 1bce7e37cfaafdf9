// ctest labels: unit
#include "core/base/input_files.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <vector>

#include "core/base/error.h"
#include "core/base/output_files.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

namespace fs = std::filesystem;

class InputFiles : public testing::Test {
  protected:
    fs::path write(const std::string& name, const std::string& text = "text") {
        fs::path file = folder_ / name;
        std::ofstream(file) << text;
        return file;
    }

    test::TempDir directory_;
    fs::path folder_ = directory_.path();
};

TEST_F(InputFiles, AreKnownByEveryName) {
    const fs::path file = write("scene.yaml");
    EXPECT_FALSE(is_input(file));
    EXPECT_EQ(read_text_file(file, "scene.yaml", 100, "scene"), "text");
    fs::create_directory(folder_ / "sub");
    fs::create_symlink(file, folder_ / "soft");
    fs::create_hard_link(file, folder_ / "hard");
    fs::create_directory_symlink(folder_, folder_ / "sub" / "up");
    for (const char* name : {"scene.yaml", "sub/../scene.yaml", "soft", "hard", "sub/up/hard"})
        EXPECT_TRUE(is_input(folder_ / name)) << name;
    fs::copy_file(file, folder_ / "copy");
    EXPECT_FALSE(is_input(folder_ / "copy"));
    EXPECT_FALSE(is_input(folder_ / "missing"));
}

TEST_F(InputFiles, AreNoFolders) {
    EXPECT_TRUE(is_file(write("scene.yaml")));
    fs::create_symlink("scene.yaml", folder_ / "soft");
    EXPECT_TRUE(is_file(folder_ / "soft"));
    EXPECT_FALSE(is_file(folder_));
    EXPECT_FALSE(is_file(folder_ / "missing"));
    EXPECT_FALSE(is_file(folder_ / "scene.yaml" / "within"));
    EXPECT_FALSE(is_file(""));
}

TEST_F(InputFiles, AreNamedIfTheyLieElsewhere) {
    for (const char* sub : {"scenes", "scenes/meshes", "scenes of others"})
        fs::create_directory(folder_ / sub);
    const fs::path elsewhere = write("plume.vdb"), neighbour = write("scenes of others/a.csv");
    fs::create_symlink(elsewhere, folder_ / "scenes/link.vdb");
    for (const char* name :
         {"scenes/meshes/../meshes/b.ply", "scenes/s.yaml", "scenes/link.vdb", "plume.vdb"}) {
        if (!fs::exists(folder_ / name)) write(name);
        remember_input(folder_ / name);
    }
    remember_input(neighbour);
    std::vector<fs::path> of_this_test;
    for (const fs::path& file : inputs_outside(folder_ / "scenes" / "meshes" / ".."))
        if (file.string().starts_with(fs::canonical(folder_).string()))
            of_this_test.push_back(file);
    EXPECT_EQ(of_this_test, (std::vector{fs::canonical(elsewhere), fs::canonical(neighbour)}));
}

TEST_F(InputFiles, StayInputsWhenTheyAreRenamedOrChanged) {
    const fs::path file = write("a");
    remember_input(file);
    fs::rename(file, folder_ / "b");
    EXPECT_TRUE(is_input(folder_ / "b"));
    const fs::path other = write("c");
    remember_input(other);
    std::ofstream(other, std::ios::app) << "more";
    fs::last_write_time(other, fs::file_time_type::clock::now() + std::chrono::hours(1));
    EXPECT_TRUE(is_input(other));
}

// File systems give the number of a deleted file to the next one.
TEST_F(InputFiles, AreNotTheFilesThatComeAfterThem) {
    for (int i = 0; i < 20; ++i) {
        const fs::path file = write("old");
        fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1));
        remember_input(file);
        fs::remove(file);
        EXPECT_FALSE(is_input(write("new" + std::to_string(i))));
    }
}

TEST_F(InputFiles, AreNeverReplaced) {
    const fs::path file = write("table.csv", "precious");
    remember_input(file);
    fs::create_hard_link(file, folder_ / "stats.json");
    for (const fs::path& target : {file, folder_ / "stats.json"}) {
        try {
            const AtomicFile output(target);
            ADD_FAILURE() << target;
        } catch (const IoError& error) {
            EXPECT_EQ(error.what(), target.string() +
                                        ": cannot write: it is a file that this run reads; choose "
                                        "another name");
        }
    }
    // What is read only after the output was begun.
    const fs::path late = write("late", "precious");
    AtomicFile output(late);
    std::ofstream(output.temporary_path()) << "new";
    remember_input(late);
    EXPECT_THROW(output.commit(), IoError);
    EXPECT_EQ(read_text_file(late, "late", 100, "file"), "precious");
}

TEST_F(InputFiles, AreReplacedByTheirNextVersionAlone) {
    const fs::path file = write("scene.yaml", "old");
    remember_input(file);
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
    AtomicFile output(file, ReadTarget::replace);
    std::ofstream(output.temporary_path()) << "new";
    EXPECT_EQ(read_text_file(file, "", 100, "file"), "old");
    output.commit();
    EXPECT_EQ(read_text_file(file, "", 100, "file"), "new");
    EXPECT_EQ(fs::status(file).permissions(),
              fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
    EXPECT_THROW(AtomicFile{file}, IoError) << "it has been read again";
}

TEST(LiesWithin, FollowsLinks) {
    const test::TempDir directory;
    const fs::path folder = directory / "scene";
    fs::create_directories(folder / "sub");
    fs::create_directories(directory / "scenes");
    for (const fs::path& file : {folder / "in", directory / "out"}) std::ofstream(file) << "text";
    fs::create_symlink(directory / "out", folder / "link");
    fs::create_symlink(directory.path(), folder / "up");
    fs::create_symlink("../in", folder / "sub/in");
    fs::create_symlink(directory / "none", folder / "dangling");
    fs::create_symlink("none", folder / "sub/dangling");
    for (const char* name : {"in", "sub/in", "sub/../in", ".", "none", "sub/none/at/all",
                             "up/scene/in", "../scene/in"})
        EXPECT_TRUE(lies_within(folder, folder / name)) << name;
    for (const char* name : {"..", "../out", "../scenes/in", "link", "up", "up/out", "up/none",
                             "dangling", "dangling/x", "sub/dangling", "/etc/passwd"})
        EXPECT_FALSE(lies_within(folder, folder / name)) << name;
    fs::create_directory_symlink(folder, directory / "same");
    EXPECT_TRUE(lies_within(directory / "same", folder / "in"));
    EXPECT_TRUE(lies_within(folder, directory / "same/in"));
}

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

TEST(FileStamps, AreCurrentUntilOneFileChanges) {
    const test::TempDir folder;
    EXPECT_TRUE(FileStamps().are_current());
    const auto write = [&](const char* name) { std::ofstream(folder / name) << name; };
    write("a");
    FileStamps stamps({folder / "a"});
    stamps.add(FileStamps({folder / "b"}));
    EXPECT_TRUE(stamps.are_current());
    write("b");  // which there was not
    EXPECT_FALSE(stamps.are_current());
}

}  // namespace
}  // namespace uw
