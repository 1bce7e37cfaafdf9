// ctest labels: metamorphic
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/support/random/scene_invariants.h"

namespace uw::test {
namespace {

// As many as take some 10 s, from the first after two that take as long alone: one takes 0.7 s in
// the mean, four images and two pixels by the reference. tests/render/many_random_scenes.cpp takes
// 5000, and multiple scattering, too.
TEST(RandomScenes, FulfilWhatEveryImageDoes) {
    constexpr int k_first = 8, k_scenes = 16;
    const InvariantCounts counts = hold_invariants(k_first, k_scenes, Scattered::once);
    std::printf("seeds %d to %d: %d rendered, %d refused, %d left out, %d pixels compared\n",
                k_first, k_first + k_scenes - 1, counts.rendered, counts.refused, counts.left_out,
                counts.compared);
    // The generator is to make scenes, not errors; some volumes and lamps end up too far away.
    EXPECT_GE(counts.rendered + counts.left_out, 9 * k_scenes / 10);
    EXPECT_GE(counts.rendered, k_scenes / 2);
    EXPECT_GE(counts.compared, k_scenes / 2);
}

}  // namespace
}  // namespace uw::test
