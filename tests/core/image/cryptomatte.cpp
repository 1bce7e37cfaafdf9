// ctest labels: unit
#include "core/image/cryptomatte.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

namespace uw {
namespace {

TEST(Cryptomatte, HashesAreThoseOfMurmurHash3) {
    EXPECT_EQ(murmur_hash_3(""), 0U);
    EXPECT_EQ(murmur_hash_3("test"), 0xba6bd213U);
    EXPECT_EQ(murmur_hash_3("Hello, world!"), 0xc0363e43U);
    EXPECT_EQ(murmur_hash_3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723U);
}

TEST(Cryptomatte, IdentifiersAreNormalNumbersAndDiffer) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(matte_id("test")), 0xba6bd213U);
    int changed = 0;
    for (int i = 0; i < 20'000; ++i) {
        const std::string name = "object " + std::to_string(i);
        EXPECT_TRUE(std::isnormal(matte_id(name))) << name;
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(matte_id(name));
        if (bits == murmur_hash_3(name)) continue;
        EXPECT_EQ(bits ^ murmur_hash_3(name), 0x00800000U) << name;
        ++changed;
    }
    EXPECT_NEAR(changed, 20'000 * 2.0 / 256, 60);  // two of 256 exponents
}

TEST(Cryptomatte, SharesAreStoredFromTheLargestOn) {
    std::vector<Matte> mattes;
    for (int i = 1; i <= 8; ++i) add_matte(static_cast<float>(i), 0.01 * i, mattes);
    add_matte(1, 0.5, mattes);
    add_matte(0, 0.9, mattes);
    std::array<float, k_matte_values> channels{};
    store_mattes(mattes, channels);
    const std::array<float, k_matte_values> wanted{1, 0.51f, 8, 0.08f, 7, 0.07f,
                                                   6, 0.06f, 5, 0.05f, 4, 0.04f};
    EXPECT_EQ(channels, wanted);
}

TEST(Cryptomatte, MeansAreOfEachIdentifier) {
    std::array<float, k_matte_values> mean{2, 0.75f, 3, 0.25f};
    const std::array<float, k_matte_values> more{3, 0.5f, 4, 0.25f};
    mix_mattes(more, 0.5, mean);
    const std::array<float, k_matte_values> wanted{2, 0.375f, 3, 0.375f, 4, 0.125f};
    EXPECT_EQ(mean, wanted);
    const std::array<float, k_matte_values> before{5, 0.7f, 6, 0.1f};
    std::array<float, k_matte_values> same = before;
    mix_mattes(before, 1.0 / 3, same);
    EXPECT_EQ(same, before);
}

}  // namespace
}  // namespace uw
