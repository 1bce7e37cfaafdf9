// ctest labels: metamorphic slow
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>

#include "tests/support/random/scene_invariants.h"

namespace uw::test {
namespace {

// Scenes take 0.5 s of CPU time each in the mean. tests/render/random/thousands_of_scenes.cpp
// takes 5000, and light that is scattered more than once, too.
TEST(HundredRandomScenes, FulfilWhatEveryImageDoes) {
    constexpr int k_seeds = 126, k_scenes = 99;
    const InvariantCounts counts = hold_invariants(0, k_seeds, Scattered::once);
    std::printf("seeds 0 to %d: %d rendered, %d refused, %d left out, %d pixels compared\n",
                k_seeds - 1, counts.rendered, counts.refused, counts.left_out, counts.compared);
    // The generator is to make scenes, not errors; some volumes and lamps end up too far away.
    EXPECT_LE(counts.refused, k_seeds / 20);
    EXPECT_GE(counts.rendered, k_scenes);
    EXPECT_GE(counts.compared, k_scenes);
    EXPECT_GE(counts.bounded, k_scenes);
}

TEST(HundredRandomScenes, FulfilItWhereOthersOnceDidNot) {
    for (const std::uint64_t seed : {139U, 235U})
        EXPECT_EQ(hold_invariants(seed, 1, Scattered::once).rendered, 1);
}

}  // namespace
}  // namespace uw::test
