// ctest labels: unit
#include "core/image/loaded_module.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/temp_dir.h"

namespace uw {
namespace {

// A program has what the package system, the build folder or an installation from it gives it, and
// whoever runs it has one command for each.
TEST(LoadedModule, IsInstalledAsItsProgramWas) {
    const test::TempDir folder;
    const std::filesystem::path build = folder / "clone/build/release";
    std::filesystem::create_directories(build);
    std::ofstream(build / "CMakeCache.txt") << "";
    for (const char* packaged :
         {"/usr/bin/uwvdb", "/usr/lib/x86_64-linux-gnu/libuwvdb.so.1.0.0",
          "/usr/lib/python3/dist-packages/uwvdb/_uwvdb.cpython-311-x86_64-linux-gnu.so"})
        EXPECT_EQ(how_to_install("uwvdb-fitting", packaged), "install the package uwvdb-fitting");
    for (const std::filesystem::path& built :
         {build / "cli/uwvdb", build / "libuwvdb.so.1.0.0", build / "python/uwvdb/_uwvdb.so"})
        EXPECT_EQ(
            how_to_install("uwvdb-fitting", built),
            "run scripts/demo, which installs what is missing and builds the rest of the program");
    for (const std::filesystem::path& installed :
         {std::filesystem::path("/usr/local/bin/uwvdb"), folder / ".local/bin/uwvdb",
          std::filesystem::path("/usrlocal/bin/uwvdb")})
        EXPECT_EQ(
            how_to_install("uwvdb-fitting", installed),
            "run scripts/demo in the repository that this program was built from, and install "
            "it again");
}

TEST(LoadedModule, KnowsTheProgramItIsIn) {
    EXPECT_EQ(own_file(), std::filesystem::canonical("/proc/self/exe"));
}

}  // namespace
}  // namespace uw
