// ctest labels: unit analytic
// The light that paths expect in water that a sun illuminates.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/light/sunlight.h"
#include "core/paths/path_tables.h"
#include "tests/support/paths/path_scene.h"

namespace uw::test {
namespace {

/// Chandrasekhar's function H of isotropic scattering (Radiative Transfer, 1960, section 37),
/// by iterating 1 / H(mu) = sqrt(1 - albedo) + albedo / 2 int m H(m) / (mu + m) dm.
class HFunction {
  public:
    explicit HFunction(double albedo) : albedo_(albedo) {
        values_.fill(1);
        for (int i = 0; i < 200; ++i) {
            std::array<double, k_nodes> next{};
            for (std::size_t j = 0; j < k_nodes; ++j) next[j] = (*this)(node(j));
            values_ = next;
        }
    }

    double operator()(double mu) const {
        double integral = 0;
        for (std::size_t j = 0; j < k_nodes; ++j)
            integral += node(j) * values_[j] / (mu + node(j)) / k_nodes;
        return 1 / (std::sqrt(1 - albedo_) + 0.5 * albedo_ * integral);
    }

  private:
    static constexpr std::size_t k_nodes = 100;
    static double node(std::size_t j) { return (static_cast<double>(j) + 0.5) / k_nodes; }

    double albedo_;
    std::array<double, k_nodes> values_{};
};

// Water scatters back what a sun sends into it, more than once: where little of that is expected,
// paths that find it are rare and far too bright, and the errors of deep light meters too small.
// How far an expectation is off shows in the variance, as about its factor.
TEST(GuidesOfSuns, ExpectWhatDeepWaterScattersBack) {
    constexpr double k_factor = 4;
    int compared = 0;
    for (const double albedo : {0.2, 0.5, 0.9, 0.97}) {
        const HFunction h(albedo);
        const Spectrum one = per_band(1, [](std::size_t) { return 1.0; });
        PathScene scene({{1 - albedo, albedo}}, 0);
        const ScatteringTables scattering(scene.medium);
        for (const double mu_sun : {1.0, 0.75}) {
            const Sunlight sunlight{{std::sqrt(1 - mu_sun * mu_sun), 0, mu_sun},
                                    {{0, 0, 0}, {0, 0, -1}}};
            scene.lamps = {Lamp("sun", sunlight, one)};
            const EmissionSampler emission(scene.lit());
            const PathTables tables(scene.lit(), scattering, emission, {}, {0});
            GuidingDistribution guides;
            for (const double depth : {1e-4, 1e-2, 0.1}) {
                guides.find(tables.guides, {0, 0, depth}, one);
                for (const double mu : {1.0, 0.6, 0.3}) {
                    const double truth = albedo / (4 * std::numbers::pi) * mu_sun / (mu + mu_sun) *
                                         (h(mu) * h(mu_sun) - 1);
                    const double expected = guides.multiple({0, std::sqrt(1 - mu * mu), mu});
                    EXPECT_GT(expected, truth / k_factor)
                        << "albedo " << albedo << ", sun " << mu_sun << ", depth " << depth
                        << ", direction " << mu;
                    EXPECT_LT(expected, truth * k_factor)
                        << "albedo " << albedo << ", sun " << mu_sun << ", depth " << depth
                        << ", direction " << mu;
                    ++compared;
                }
            }
        }
    }
    EXPECT_EQ(compared, 72);
}

}  // namespace
}  // namespace uw::test
