// ctest labels: unit analytic
#include "core/paths/distance_intervals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/light/integrator.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

class Intervals : public testing::Test {
  protected:
    Intervals() {
        desc_.geometry = {plane_at_z(3)};
        desc_.lamps = {isotropic_lamp({-0.5, -0.2, 0}, 40)};
    }
    DistanceIntervals intervals() {
        renderer_.set_scene(SceneDesc(desc_));
        const AssembledScene& scene = renderer_.assemble();
        return {*scene.camera, scene.lit()};
    }
    SceneDesc desc_ = pinhole_scene(12, 9);
    Renderer renderer_;
};

TEST_F(Intervals, CoverEveryDistanceOnce) {
    for (const bool is_open : {false, true}) {
        if (is_open) desc_.geometry.clear();
        const DistanceIntervals all = intervals();
        EXPECT_EQ(all.begin(0), 0);
        EXPECT_GE(all.end(all.count() - 1), k_far);
        for (std::size_t i = 0; i + 1 < all.count(); ++i) {
            EXPECT_LT(all.begin(i), all.end(i));
            EXPECT_EQ(all.end(i), all.begin(i + 1));
            EXPECT_EQ(all.at(0.5 * (all.begin(i) + all.end(i))), i);
        }
        EXPECT_EQ(all.at(0), 0U);
        EXPECT_EQ(all.at(2 * k_far), all.count() - 1);
    }
}

TEST_F(Intervals, DivideTheLightOfAUniformSource) {
    const DistanceIntervals all = intervals();
    const Spectrum c = renderer_.assembled().water.medium.uniform.attenuation();
    for (std::size_t i = 0; i < 10; ++i) {
        for (std::size_t b = 0; b < 3; ++b) {
            EXPECT_EQ(all.fraction_before(i, b, all.begin(i)), 0);
            EXPECT_EQ(all.fraction_before(i, b, all.end(i)), 1);
            const double s = 0.3 * all.begin(i) + 0.7 * all.end(i);
            // int e^(-c s) ds up to s, relative to the whole interval; 1e-10 allows for the
            // rounding of the differences.
            const double up_to = std::exp(-c[b] * all.begin(i)) - std::exp(-c[b] * s);
            const double whole = std::exp(-c[b] * all.begin(i)) - std::exp(-c[b] * all.end(i));
            EXPECT_NEAR(all.fraction_before(i, b, s), up_to / whole, 1e-10);
        }
    }
}

}  // namespace
}  // namespace uw::test
