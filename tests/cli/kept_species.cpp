// ctest labels: unit
// What species were computed to be is kept in the user's cache folder for the next run.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>

#include "tests/support/cli_test.h"
#include "tests/support/file_bytes.h"

namespace uw {
namespace {

class KeptSpecies : public test::CliTest {
  protected:
    KeptSpecies() { setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1); }
    ~KeptSpecies() override { unsetenv("XDG_CACHE_HOME"); }

    std::vector<std::filesystem::path> kept() const {
        std::vector<std::filesystem::path> files;
        const std::filesystem::path folder = folder_ / "cache/uwvdb/species";
        if (std::filesystem::exists(folder))
            for (const auto& entry : std::filesystem::directory_iterator(folder))
                files.push_back(entry.path());
        return files;
    }
};

const std::vector<std::string> k_table{"water", "--species", "clay,petzold-ocean", "--json"};

TEST_F(KeptSpecies, AreReadAgainAndReplacedWhereDamaged) {
    const auto first = run(k_table);
    ASSERT_EQ(first.exit_code, 0) << first.err;
    ASSERT_EQ(kept().size(), 3U);  // clay in three bands
    const auto read = run(k_table);
    EXPECT_EQ(read.out, first.out);
    const std::filesystem::path one = kept()[0];
    const std::string whole = test::file_bytes(one);
    for (const auto& file : kept()) std::filesystem::resize_file(file, 100);
    const auto mended = run(k_table);
    EXPECT_EQ(mended.out, first.out);
    EXPECT_EQ(test::file_bytes(one), whole);
}

// Nor waited for: nobody writes to the pipe, and the device never ends.
TEST_F(KeptSpecies, AreComputedAgainWherePipesAndDevicesStand) {
    const auto first = run(k_table);
    ASSERT_EQ(first.exit_code, 0) << first.err;
    const std::vector<std::filesystem::path> files = kept();
    ASSERT_EQ(files.size(), 3U);
    for (const auto& file : files) std::filesystem::remove(file);
    ASSERT_EQ(::mkfifo(files[0].c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", files[1]);
    std::filesystem::create_directory(files[2]);
    const auto again =
        test::run_program(k_table, {.folder = folder_.path(), .timeout_seconds = 60});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(again.out, first.out);
    EXPECT_TRUE(std::filesystem::is_fifo(files[0]));
}

TEST_F(KeptSpecies, AreNotLookedForWhereInputsAreConfined) {
    write("s.yaml",
          "uwvdb: 1\ncamera: {resolution: [4, 3], intrinsics: {fov_x: 60}}\n"
          "water: {species: {clay: {library: clay}}, particles: {clay: 1}}\n"
          "lamps: [{position: [1, 0, 0], intensity: 50}]\n");
    const auto confined = run({"render", "s.yaml", "-o", "a.exr", "--confine"});
    EXPECT_EQ(confined.exit_code, 0) << confined.err;
    EXPECT_TRUE(kept().empty());
    const auto free = run({"render", "s.yaml", "-o", "b.exr"});
    EXPECT_EQ(free.exit_code, 0) << free.err;
    EXPECT_EQ(kept().size(), 3U);
}

}  // namespace
}  // namespace uw
