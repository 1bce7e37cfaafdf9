// ctest labels: unit
#include "core/base/output_files.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

/// Sets TMPDIR for as long as it lives.
class TemporaryFolderIs {
  public:
    explicit TemporaryFolderIs(const std::filesystem::path& folder) {
        if (const char* value = getenv("TMPDIR")) before_ = value;
        setenv("TMPDIR", folder.c_str(), 1);
    }
    ~TemporaryFolderIs() {
        if (before_)
            setenv("TMPDIR", before_->c_str(), 1);
        else
            unsetenv("TMPDIR");
    }
    TemporaryFolderIs(const TemporaryFolderIs&) = delete;
    TemporaryFolderIs& operator=(const TemporaryFolderIs&) = delete;
    TemporaryFolderIs(TemporaryFolderIs&&) = delete;
    TemporaryFolderIs& operator=(TemporaryFolderIs&&) = delete;

  private:
    std::optional<std::string> before_;
};

TEST(ScratchFolder, IsItsOwnAndGoesWithItsContent) {
    std::filesystem::path kept;
    {
        const ScratchFolder folder, other;
        kept = folder.path();
        EXPECT_TRUE(std::filesystem::is_directory(kept));
        EXPECT_NE(kept, other.path());
        std::filesystem::create_directories(kept / "a" / "b");
        std::ofstream(kept / "a" / "b" / "file") << "text";
        EXPECT_TRUE(std::filesystem::exists(kept / "a" / "b" / "file"));
    }
    EXPECT_FALSE(std::filesystem::exists(kept));
}

TEST(ScratchFolder, StandsWhereTheUserWants) {
    const test::TempDir wanted;
    const TemporaryFolderIs set(wanted.path());
    EXPECT_EQ(ScratchFolder().path().parent_path(), wanted.path());
}

TEST(ScratchFolder, SaysWhatToDoWhereNoneCanBeMade) {
    const test::TempDir folder;
    std::ofstream(folder / "file") << "text";
    for (const char* name : {"missing", "file"}) {
        const TemporaryFolderIs set(folder / name);
        const std::string message = test::message_of<IoError>([] { const ScratchFolder none; });
        EXPECT_NE(message.find("set TMPDIR to a writable one"), std::string::npos) << message;
    }
}

}  // namespace
}  // namespace uw
