// ctest labels: unit
#include "core/base/output_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "core/base/error.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
    std::ofstream(file) << text;
}

std::string read(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::ptrdiff_t files_in(const fs::path& folder) {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

std::string error_of(const fs::path& target) {
    try {
        const AtomicFile file(target);
    } catch (const IoError& error) {
        return error.what();
    }
    return "nothing thrown";
}

class AtomicFileTest : public testing::Test {
  protected:
    test::TempDir directory_;
    fs::path folder_ = directory_.path();
    fs::path target_ = folder_ / "image.exr";
};

TEST_F(AtomicFileTest, CommitReplacesTheTarget) {
    write(target_, "old");
    AtomicFile file(target_);
    EXPECT_EQ(file.temporary_path().parent_path(), folder_);
    write(file.temporary_path(), "new");
    EXPECT_EQ(read(target_), "old");
    file.commit();
    EXPECT_EQ(read(target_), "new");
    EXPECT_EQ(files_in(folder_), 1);
}

TEST_F(AtomicFileTest, WithoutCommitTheTargetIsUntouched) {
    write(target_, "old");
    {
        const AtomicFile file(target_);
        write(file.temporary_path(), "half");
    }
    EXPECT_EQ(read(target_), "old");
    EXPECT_EQ(files_in(folder_), 1);
}

TEST_F(AtomicFileTest, CommitThatFailsLeavesNothingBehind) {
    AtomicFile file(target_);
    fs::create_directories(target_ / "in the way");
    EXPECT_THROW(file.commit(), IoError);
    EXPECT_TRUE(fs::is_directory(target_));
}

TEST_F(AtomicFileTest, SeveralAtOnceDoNotMeet) {
    AtomicFile a(target_), b(target_);
    EXPECT_NE(a.temporary_path(), b.temporary_path());
}

TEST_F(AtomicFileTest, PermissionsAreThoseOfAnyNewFile) {
    write(folder_ / "plain", "");
    AtomicFile file(target_);
    file.commit();
    EXPECT_EQ(fs::status(target_).permissions(), fs::status(folder_ / "plain").permissions());
}

TEST_F(AtomicFileTest, SymbolicLinksAreWrittenThrough) {
    fs::create_directory(folder_ / "elsewhere");
    write(folder_ / "elsewhere" / "real.exr", "old");
    fs::create_symlink("elsewhere/real.exr", target_);
    AtomicFile file(target_);
    write(file.temporary_path(), "new");
    file.commit();
    EXPECT_TRUE(fs::is_symlink(target_));
    EXPECT_EQ(read(folder_ / "elsewhere" / "real.exr"), "new");
}

TEST_F(AtomicFileTest, SymbolicLinksToWhatIsNotThereYet) {
    fs::create_directory(folder_ / "elsewhere");
    fs::create_symlink("second", folder_ / "elsewhere" / "first");
    fs::create_symlink("elsewhere/first", target_);
    AtomicFile file(target_);
    write(file.temporary_path(), "new");
    file.commit();
    EXPECT_TRUE(fs::is_symlink(target_));
    EXPECT_EQ(read(folder_ / "elsewhere" / "second"), "new");
    fs::create_symlink("circle.exr", folder_ / "circle.exr");
    EXPECT_NE(error_of(folder_ / "circle.exr").find("circle"), std::string::npos);
}

TEST_F(AtomicFileTest, MakesItsFolders) {
    const fs::path target = folder_ / "a" / "b" / "image.exr";
    {
        const AtomicFile probe(target);
        EXPECT_EQ(probe.temporary_path().parent_path(), folder_ / "a" / "b");
    }
    EXPECT_EQ(files_in(folder_), 0);  // nothing was committed
    {
        AtomicFile other(folder_ / "a" / "image.exr");
        {
            AtomicFile file(target);
            write(file.temporary_path(), "new");
            file.commit();
        }
    }
    EXPECT_EQ(read(target), "new");
    EXPECT_EQ(files_in(folder_ / "a"), 1);  // kept: it holds the folder of the other
    fs::create_symlink("c/image.exr", folder_ / "link.exr");
    AtomicFile linked(folder_ / "link.exr");
    EXPECT_EQ(linked.temporary_path().parent_path(), folder_ / "c");
}

TEST_F(AtomicFileTest, SaysWhatIsWrongWithTheTarget) {
    write(folder_ / "file", "");
    const std::string wrong = error_of(folder_ / "file" / "image.exr");
    EXPECT_NE(wrong.find((folder_ / "file" / "image.exr").string()), std::string::npos);
    EXPECT_NE(wrong.find("not a folder"), std::string::npos);
    EXPECT_NE(error_of(folder_ / "file" / "deeper" / "image.exr").find("cannot write"),
              std::string::npos);
    EXPECT_NE(error_of(folder_).find("it is a folder"), std::string::npos);
    EXPECT_NE(error_of(folder_ / "").find("file name"), std::string::npos);
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    EXPECT_NE(error_of(folder_ / "pipe").find("not a regular file"), std::string::npos);
    EXPECT_EQ(files_in(folder_), 2);
}

TEST_F(AtomicFileTest, FolderWithoutPermission) {
    fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
    // The permissions of files do not bind root: look as somebody else then.
    constexpr uid_t k_nobody = 65534;
    const bool is_root = ::geteuid() == 0;
    if (is_root) {
        fs::permissions(folder_, fs::perms::others_read | fs::perms::others_exec);
        ASSERT_EQ(::seteuid(k_nobody), 0);
    }
    const std::string error = error_of(target_);
    if (is_root) {
        ASSERT_EQ(::seteuid(0), 0);
    }
    fs::permissions(folder_, fs::perms::owner_all);
    EXPECT_NE(error.find("no permission to write"), std::string::npos) << error;
}

// Files of a process that was killed are removed; those of another machine that shares the folder
// are in other hands.
TEST_F(AtomicFileTest, RemovesWhatNobodyWritesAnyMore) {
    const AtomicFile file(target_);
    fs::path left = folder_ / AtomicFile(target_).temporary_path().filename();
    const fs::path other = folder_ / ".uwvdb-1234-5.tmp", own = folder_ / "mine.tmp";
    for (const fs::path& name : {left, other, own}) write(name, "half");
    AtomicFile::remove_left_overs(folder_);
    EXPECT_TRUE(fs::exists(file.temporary_path()));
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::exists(other));
    AtomicFile::remove_left_overs(folder_, true);
    EXPECT_TRUE(fs::exists(file.temporary_path()));
    EXPECT_FALSE(fs::exists(other));
    EXPECT_TRUE(fs::exists(own));
    EXPECT_NO_THROW(AtomicFile::remove_left_overs(folder_ / "none"));
}

}  // namespace
}  // namespace uw
