// ctest labels: statistical metamorphic slow
// Reciprocity of light paths.
#include <gtest/gtest.h>

#include "tests/support/gaussian_field.h"
#include "tests/support/geometry_descs.h"
#include "tests/support/paths/mean_fluence.h"

namespace uw::test {
namespace {

// The fluence at B from an isotropic lamp at A equals that at A from the lamp at B, as every path
// may be reversed; also with a box between them that hides one from the other, and with a cloud.
TEST(PathReciprocity, LampAndDetectorMayBeExchanged) {
    constexpr Point3 k_a{-0.9, 0.2, 0.7}, k_b{0.8, -0.1, 1.6};
    const auto fluence = [&](const Point3& lamp, const Point3& detector, std::uint64_t seed) {
        PathScene scene({{0.1, 0.5}, {0.3, 0.3}}, 0.85);
        scene.set_field(std::make_unique<GaussianField>(Point3{0.7, 0.4, 1.4}, 0.3, 1.0, 0.02),
                        {{0.2, 1.5}, {0.1, 0.5}}, 0.5);
        scene.set_surfaces({with_reflectance(box({-0.3, -0.3, 0.8}, {0.2, 0.3, 1.4}), 0.7, 2),
                            with_reflectance(plane({0, 0, 2.5}, {0.1, 0, -1}), 0.6, 2)});
        scene.add_lamp(lamp, 1);
        const PathTracer tracer(scene.lit());
        return run_batches(32, 2, seed, [&](std::uint64_t batch_seed, TermSums& sums) {
            constexpr int k_directions = 1 << 10;
            std::mt19937_64 engine(batch_seed);
            std::uniform_real_distribution<double> uniform;
            for (int i = 0; i < k_directions; ++i)
                add_fluence(scene.lit(), tracer, detector, (i + uniform(engine)) / k_directions,
                            uniform(engine), engine(), 8, 1.0 / k_directions, sums);
        });
    };
    const auto there = fluence(k_a, k_b, 1), back = fluence(k_b, k_a, 2);
    Deviations deviations, totals;
    for (const std::size_t band : {0U, 1U}) {
        for (int s = 0; s <= 3; ++s)
            for (int r = 0; r <= 2; ++r) {
                const auto of = [&](const std::vector<TermSums>& batches) {
                    return means_of(batches, [&](const TermSums& sums) {
                        return sums.sum(band, [&](int m, int n, bool) {
                            return std::min(m, 3) == s && std::min(n, 2) == r;
                        });
                    });
                };
                const BatchMeans one = of(there), other = of(back);
                if (s + r == 0) {  // hidden
                    EXPECT_EQ(one.mean(), 0);
                    EXPECT_EQ(other.mean(), 0);
                } else if (s > 0 || r > 1) {
                    deviations.add("band " + std::to_string(band) + " scatterings " +
                                       std::to_string(s) + " reflections " + std::to_string(r),
                                   one, other.mean(), other.error());
                }
            }
        const auto total = [&](const TermSums& sums) { return sums.total(band); };
        const BatchMeans one = means_of(there, total), other = means_of(back, total);
        totals.add("band " + std::to_string(band), one, other.mean(), other.error());
    }
    deviations.expect_within_errors();
    totals.expect_within_errors();
    totals.expect_errors_below(0.015);
}

}  // namespace
}  // namespace uw::test
