// ctest labels: unit analytic
#include "core/multiple/interval_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/integrators/integrator.h"
#include "media/phase/henyey_greenstein.h"
#include "tests/support/gaussian_field.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// Water of two bands with a cloud of particles.
class IntervalWeightsTest : public testing::Test {
  protected:
    IntervalWeightsTest() {
        SceneDesc desc = pinhole_scene(12, 9);
        desc.geometry = {plane_at_z(3)};
        renderer_.set_scene(std::move(desc));
        const AssembledScene& scene = renderer_.assemble();
        lit_ = scene.lit();
        medium_.wavelengths_nm = {550, 450};
        medium_.phase_functions = {std::make_shared<HenyeyGreenstein>(0.9)};
        medium_.uniform.scattering.resize(1);
        Constituent particles{"small", "ppm", {}};
        particles.per_unit.scattering.resize(1);
        for (const std::size_t b : {0U, 1U}) {
            medium_.uniform.absorption[b] = k_absorption[b];
            medium_.uniform.scattering[0][b] = k_scattering[b];
            particles.per_unit.absorption[b] = k_absorption_per_ppm[b];
            particles.per_unit.scattering[0][b] = k_scattering_per_ppm[b];
        }
        medium_.constituents = {particles};
        lit_.medium = &medium_;
        intervals_ = std::make_unique<DistanceIntervals>(*scene.camera, lit_);
    }

    static constexpr std::array k_absorption{0.1, 0.3}, k_scattering{0.2, 0.0},
        k_absorption_per_ppm{0.01, 0.1}, k_scattering_per_ppm{0.5, 1.0};
    const Ray ray_{{0, 0, 0}, {0, 0, 1}};
    Renderer renderer_;
    Medium medium_;
    LitScene lit_;
    std::unique_ptr<DistanceIntervals> intervals_;
};

TEST_F(IntervalWeightsTest, OfUniformWaterHaveAClosedForm) {
    const IntervalWeights weights(lit_, *intervals_);
    std::vector<float> found;
    weights.find(ray_, found);
    ASSERT_EQ(found.size(), intervals_->count() * 2);
    for (const double reach : {0.7, 2.9, k_far}) {
        for (std::size_t i = 0; i < intervals_->count(); ++i) {
            const double end = std::min(reach, intervals_->end(i));
            const double begin = std::min(reach, intervals_->begin(i));
            for (const std::size_t b : {0U, 1U}) {
                const double c = k_absorption[b] + k_scattering[b];
                const double truth =
                    k_scattering[b] / c * (std::exp(-c * begin) - std::exp(-c * end));
                EXPECT_NEAR(found[i * 2 + b] * intervals_->share(i, b, reach), truth,
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
                const double depth = (k_absorption[b] + k_scattering[b]) * s +
                                     (k_absorption_per_ppm[b] + k_scattering_per_ppm[b]) * column;
                truth += (k_scattering[b] + k_scattering_per_ppm[b] * concentration) *
                         std::exp(-depth) * (end - begin) / k_steps;
            }
            // Knots a twentieth of the cloud's sigma apart, linear in between: h^2 / 8 of its
            // curvature; of the columns in front, too, which is more where little light is left.
            EXPECT_NEAR(found[i * 2 + b], truth, 2e-3 * truth + 1e-6) << i << " band " << b;
        }
    }
}

}  // namespace
}  // namespace uw::test
