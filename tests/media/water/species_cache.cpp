// ctest labels: unit
#include "media/water/species_cache.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "media/water/species.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

using namespace uw::test;

class SpeciesCache : public testing::Test {
  protected:
    SpeciesCache() { keep_species_in(folder()); }
    ~SpeciesCache() override { keep_species_in({}); }

    std::filesystem::path folder() const { return dir_ / "cache" / "species"; }
    std::vector<std::filesystem::path> files() const {
        std::vector<std::filesystem::path> all;
        if (std::filesystem::exists(folder()))
            for (const auto& entry : std::filesystem::directory_iterator(folder()))
                all.push_back(entry.path());
        return all;
    }

    TempDir dir_;
};

TEST_F(SpeciesCache, ReturnsWhatWasKept) {
    EXPECT_FALSE(kept_results("key", 2));
    keep_results("key", {1.5, 0});
    EXPECT_EQ(kept_results("key", 2), (std::vector{1.5, 0.0}));
    EXPECT_FALSE(kept_results("key", 3));
    EXPECT_FALSE(kept_results("other key", 2));
    keep_species_in({});
    EXPECT_FALSE(kept_results("key", 2));
}

TEST_F(SpeciesCache, TrustsNoDamagedFile) {
    keep_results("key", {1.5, 0.25});
    ASSERT_EQ(files().size(), 1U);
    const std::string whole = file_bytes(files()[0]);
    const auto write = [&](const std::string& bytes) {
        std::ofstream(files()[0], std::ios::binary) << bytes;
    };
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
        write(damaged);
        EXPECT_FALSE(kept_results("key", 2)) << i;
        write(whole.substr(0, i));
        EXPECT_FALSE(kept_results("key", 2)) << i;
    }
    write(whole + "x");
    EXPECT_FALSE(kept_results("key", 2));
    keep_results("key", {1.5, 0.25});  // and is replaced
    EXPECT_TRUE(kept_results("key", 2));
}

TEST_F(SpeciesCache, ThatCannotBeWrittenCostsNothingElse) {
    std::ofstream(dir_ / "file") << "in the way";
    keep_species_in(dir_ / "file" / "species");
    keep_results("key", {1});
    EXPECT_FALSE(kept_results("key", 1));
}

TEST_F(SpeciesCache, MayBeFilledByManyAtOnce) {
    std::vector<std::jthread> threads;
    for (int n = 0; n < 8; ++n)
        threads.emplace_back([n] {
            for (int i = 0; i < 20; ++i) {
                const std::string key = "key " + std::to_string((i + n) % 5);
                keep_results(key, {1.0 + (i + n) % 5});
                const double expected = 1.0 + (i + n) % 5;
                EXPECT_EQ(kept_results(key, 1).value_or(std::vector{expected}).front(), expected);
            }
        });
    threads.clear();
    EXPECT_EQ(files().size(), 5U);
}

// What is read is what was computed, to the bit; whatever it depends on has a file of its own.
TEST_F(SpeciesCache, HoldsSpecies) {
    SpeciesDesc species;
    species.name = "first";
    species.sizes.least = 0.5e-6;
    species.sizes.greatest = 2e-6;
    species.index.n = 1.1;
    const SpeciesOptics computed = species_optics(species, 543, 1.34);
    ASSERT_EQ(files().size(), 1U);
    species.name = "second";  // another to what is kept in memory
    int told = 0;
    const SpeciesOptics read = species_optics(species, 543, 1.34, [&](double) { ++told; });
    EXPECT_EQ(told, 0);
    EXPECT_EQ(files().size(), 1U);
    EXPECT_EQ(read.scattering, computed.scattering);
    EXPECT_EQ(read.absorption, computed.absorption);
    for (const double psi : {0.0, 0.01, 0.7, 3.0})
        EXPECT_EQ(read.phase->eval(psi), computed.phase->eval(psi));
    species.index.k = 0.01;
    EXPECT_GT(species_optics(species, 543, 1.34, [&](double) { ++told; }).absorption, 0);
    EXPECT_GT(told, 0);
    EXPECT_EQ(files().size(), 2U);
}

}  // namespace
}  // namespace uw
