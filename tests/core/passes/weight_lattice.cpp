// ctest labels: unit analytic
#include "core/passes/weight_lattice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/light/integrator.h"
#include "tests/support/gaussian_field.h"
#include "tests/support/hg_medium.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// A camera before water of one band, with or without a wide cloud of particles.
class WeightLattices : public testing::Test {
  protected:
    WeightLattices() {
        renderer_.set_scene(pinhole_scene(40, 30));
        const AssembledScene& scene = renderer_.assemble();
        rays_ = scene.camera.get();
        lit_ = scene.lit();
        add_particles(medium_, {0}, {0.5});
        lit_.medium = &medium_;
    }

    const RaySource* rays_ = nullptr;
    const GaussianField cloud_{{0.1, 0, 1.5}, 0.4, 4.0, 0.02};
    Renderer renderer_;
    Medium medium_ = hg_medium(0.9, {0.1}, {0.2});
    LitScene lit_;
};

TEST_F(WeightLattices, HoldOneSetOfWeightsInUniformWater) {
    const DistanceIntervals intervals(*rays_, lit_);
    const IntervalWeights weights(lit_, intervals);
    const WeightLattice lattice(*rays_, weights, {0, 0, 40, 30});
    std::vector<float> found;
    lattice.find(17.3, 4.9, found);
    EXPECT_EQ(found, weights.of_uniform_water());
}

TEST_F(WeightLattices, LieBetweenTheRaysOfTheLattice) {
    lit_.field = &cloud_;
    const DistanceIntervals intervals(*rays_, lit_);
    const IntervalWeights weights(lit_, intervals);
    const WeightLattice lattice(*rays_, weights, {0, 0, 40, 30});
    std::vector<float> found, truth;
    double largest = 0, difference = 0;
    for (const double y : {0.5, 13.2, 16.5, 29.5}) {
        for (const double x : {0.5, 7.9, 20.5, 22.6, 39.5}) {
            lattice.find(x, y, found);
            weights.find(*rays_->refracted_ray(x, y), truth);
            ASSERT_EQ(found.size(), truth.size());
            for (std::size_t i = 0; i < truth.size(); ++i) {
                largest = std::max(largest, std::abs(static_cast<double>(truth[i])));
                difference =
                    std::max(difference, std::abs(static_cast<double>(found[i]) - truth[i]));
                // On the lattice, where knots are the same.
                if (x == 20.5 && y == 16.5) {
                    EXPECT_FLOAT_EQ(found[i], truth[i]);
                }
            }
        }
    }
    // Linear interpolation errs by h^2 / 8 of the curvature: rays of the lattice pass the cloud
    // some 0.15 m = 0.4 sigma apart in both directions.
    ASSERT_GT(largest, 0.05);
    EXPECT_LT(difference, 0.04 * largest);
    EXPECT_GT(difference, 0.0);
}

TEST_F(WeightLattices, DoNotDependOnTheWindow) {
    lit_.field = &cloud_;
    const DistanceIntervals intervals(*rays_, lit_);
    const IntervalWeights weights(lit_, intervals);
    const WeightLattice whole(*rays_, weights, {0, 0, 40, 30});
    const WeightLattice part(*rays_, weights, {18, 11, 27, 20});
    std::vector<float> of_whole, of_part;
    for (const double y : {11.5, 15.5, 19.5}) {
        for (const double x : {18.5, 22.5, 26.5}) {
            whole.find(x, y, of_whole);
            part.find(x, y, of_part);
            EXPECT_EQ(of_whole, of_part) << x << ' ' << y;
        }
    }
}

}  // namespace
}  // namespace uw::test
