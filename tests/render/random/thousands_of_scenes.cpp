// ctest labels: metamorphic slow
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/support/random/scene_invariants.h"

namespace uw::test {
namespace {

constexpr int k_scenes_of_each = 50;

/// 100 times 50 scenes, so that one process for each part can be told from the next by its name.
class ManyRandomScenes : public testing::TestWithParam<int> {};

TEST_P(ManyRandomScenes, FulfilWhatEveryImageDoes) {
    const auto first =
        static_cast<std::uint64_t>(k_scenes_of_each) * static_cast<std::uint64_t>(GetParam());
    const InvariantCounts counts = hold_invariants(first, k_scenes_of_each, Scattered::any);
    std::printf(
        "seeds from %llu: %d rendered, %d refused, %d pixels compared; slowest %llu, %.1f s\n",
        static_cast<unsigned long long>(first), counts.rendered, counts.refused, counts.compared,
        static_cast<unsigned long long>(counts.slowest_seed), counts.slowest_cpu_seconds);
    EXPECT_GE(counts.rendered, 9 * k_scenes_of_each / 10);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ManyRandomScenes, testing::Range(0, 100));

}  // namespace
}  // namespace uw::test
