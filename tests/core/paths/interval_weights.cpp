// ctest labels: unit analytic
#include "core/paths/distance_intervals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/light/integrator.h"
#include "tests/support/gaussian_field.h"
#include "tests/support/hg_medium.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// Water of two bands with a cloud of particles.
class IntervalWeightsTest : public testing::Test {
  protected:
    IntervalWeightsTest() {
        add_particles(medium_, {0.01, 0.1}, {0.5, 1.0});
        SceneDesc desc = pinhole_scene(12, 9);
        desc.geometry = {plane_at_z(3)};
        renderer_.set_scene(std::move(desc));
        const AssembledScene& scene = renderer_.assemble();
        lit_ = scene.lit();
        lit_.medium = &medium_;
        intervals_ = std::make_unique<DistanceIntervals>(*scene.camera, lit_);
    }

    double absorption(std::size_t b) const { return medium_.uniform.absorption[b]; }
    double scattering(std::size_t b) const { return medium_.uniform.scattering[0][b]; }
    const OpticalCoefficients& per_ppm() const { return medium_.constituents[0].per_unit; }

    const Ray ray_{{0, 0, 0}, {0, 0, 1}};
    Renderer renderer_;
    Medium medium_ = hg_medium(0.9, {0.1, 0.3}, {0.2, 0.0});
    LitScene lit_;
    std::unique_ptr<DistanceIntervals> intervals_;
};

TEST_F(IntervalWeightsTest, OfUniformWaterHaveAClosedForm) {
    const IntervalWeights weights(lit_, *intervals_);
    std::vector<float> found;
    weights.find(ray_, found);
    ASSERT_EQ(found.size(), intervals_->count() * 2);
    for (const double max_distance : {0.7, 2.9, k_far}) {
        for (std::size_t i = 0; i < intervals_->count(); ++i) {
            const double end = std::min(max_distance, intervals_->end(i));
            const double begin = std::min(max_distance, intervals_->begin(i));
            for (const std::size_t b : {0U, 1U}) {
                const double c = absorption(b) + scattering(b);
                const double truth =
                    scattering(b) / c * (std::exp(-c * begin) - std::exp(-c * end));
                EXPECT_NEAR(found[i * 2 + b] * intervals_->fraction_before(i, b, max_distance),
                            truth,
                            1e-6 * truth + 1e-12)
                    << i;  // single precision
            }
        }
    }
}

TEST_F(IntervalWeightsTest, OfACloudAgreeWithQuadrature) {
    const GaussianField cloud({0.1, 0, 1.5}, 0.2, 4.0, 0.02);
    lit_.field = &cloud;
    const IntervalWeights weights(lit_, *intervals_);
    std::vector<float> found;
    weights.find(ray_, found);
    for (std::size_t i = 0; i < intervals_->count(); ++i) {
        const double end = std::min(100.0, intervals_->end(i));
        const double begin = std::min(100.0, intervals_->begin(i));
        for (const std::size_t b : {0U, 1U}) {
            constexpr int k_steps = 400;
            double truth = 0;
            for (int step = 0; step < k_steps && end > begin; ++step) {
                const double s = begin + (step + 0.5) * (end - begin) / k_steps;
                double concentration = 0, column = 0;
                cloud.sample(ray_.at(s), std::span(&concentration, 1));
                cloud.column(ray_.origin, ray_.at(s), std::span(&column, 1));
                const double depth =
                    (absorption(b) + scattering(b)) * s +
                    (per_ppm().absorption[b] + per_ppm().scattering[0][b]) * column;
                truth += (scattering(b) + per_ppm().scattering[0][b] * concentration) *
                         std::exp(-depth) * (end - begin) / k_steps;
            }
            // Linear interpolation between knots a twentieth of the cloud's sigma apart is off by
            // h^2 / 8 of the curvature; so are the columns in front, which matters more where
            // little light remains.
            EXPECT_NEAR(found[i * 2 + b], truth, 2e-3 * truth + 1e-6) << i << " band " << b;
        }
    }
}

}  // namespace
}  // namespace uw::test
