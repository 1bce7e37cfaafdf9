// ctest labels: unit
#include "core/base/input_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_dir.h"

namespace uw {
namespace {

class PointerFile : public testing::Test {
  protected:
    std::string kind_of(const std::string& bytes) const {
        std::ofstream(dir_ / "file", std::ios::binary) << bytes;
        return stand_in_of(dir_ / "file");
    }
    test::TempDir dir_;
};

// Texts as their programs' documentation has them.
TEST_F(PointerFile, GitLfsIsToldByItsFirstLine) {
    const std::string kind = kind_of(
        "version https://git-lfs.github.com/spec/v1\n"
        "oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\n"
        "size 12345\n");
    EXPECT_NE(kind.find("Git LFS pointer"), std::string::npos) << kind;
    EXPECT_NE(kind.find("git lfs pull"), std::string::npos) << kind;
}

TEST_F(PointerFile, GitAnnexIsToldByItsKey) {
    for (const char* text :
         {"/annex/objects/SHA256E-s30--abc.vdb\n",
          "../.git/annex/objects/Xk/4z/SHA256E-s30--abc.vdb/SHA256E-s30--abc.vdb"})
        EXPECT_NE(kind_of(text).find("git annex get"), std::string::npos) << text;
    std::filesystem::create_symlink(".git/annex/objects/Xk/4z/SHA256E-s30--abc.vdb/abc.vdb",
                                    dir_ / "broken.vdb");
    EXPECT_NE(stand_in_of(dir_ / "broken.vdb").find("git annex get"), std::string::npos);
}

TEST_F(PointerFile, OtherFilesAreNone) {
    EXPECT_EQ(kind_of(""), "");
    EXPECT_EQ(kind_of("version 2\n"), "");
    EXPECT_EQ(kind_of(std::string(" BDV\0\0\0\0.git/annex/objects/", 28)), "");
    EXPECT_EQ(stand_in_of(dir_ / "none"), "");
    std::filesystem::create_symlink("nowhere", dir_ / "link");
    EXPECT_EQ(stand_in_of(dir_ / "link"), "");
    EXPECT_EQ(stand_in_of(dir_.path()), "");
}

}  // namespace
}  // namespace uw
