// ctest labels: unit analytic
#include "core/paths/point_spread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "tests/support/hg_medium.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr double k_g = 0.9, k_farthest = 3;

/// Water with a Henyey-Greenstein phase function.
class PointSpreads : public testing::Test {
  protected:
    PointSpreads() {
        SceneDesc desc = pinhole_scene(12, 9);
        desc.geometry = {plane_at_z(k_farthest)};
        renderer_.set_scene(std::move(desc));
        const AssembledScene& scene = renderer_.assemble();
        intervals_ = std::make_unique<DistanceIntervals>(*scene.camera, scene.lit());
    }

    // The transfer function of all intervals from `first` on.
    static double transfer(const PointSpread& spread, std::size_t first, std::size_t band,
                           std::size_t distance, std::size_t frequency) {
        double sum = 0;
        for (std::size_t i = first; i < spread.interval_count(); ++i)
            sum += static_cast<double>(spread.transfer(i, band, distance)[frequency]);
        return sum;
    }
    double b(std::size_t band) const { return medium_.uniform.scattering[0][band]; }

    Renderer renderer_;
    std::unique_ptr<DistanceIntervals> intervals_;
    Medium medium_ = hg_medium(k_g, {0.1, 0.1}, {0.2, 1});
};

// b int_0^T p^(k (T - s) / T) ds by the midpoint rule with b T = `depth`, with the Bessel function
// itself and p up to 1 rad, beyond which no image is formed. Points at equal steps of sqrt(psi) are
// dense at the peak of p.
double exponent_of(double depth, double k) {
    constexpr int k_angles = 2000, k_places = 60;
    const auto phase = henyey_greenstein(k_g);
    double sum = 0;
    for (int i = 0; i < k_angles; ++i) {
        const double root = (i + 0.5) / k_angles, psi = root * root;
        double mean = 0;
        for (int j = 0; j < k_places; ++j)
            mean += std::cyl_bessel_j(0.0, k * psi * (j + 0.5) / k_places) / k_places;
        sum += phase->eval(psi) * mean * psi * 2 * root / k_angles;
    }
    return depth * 2 * std::numbers::pi * sum;
}

TEST_F(PointSpreads, HaveTheTransferFunctionOfSmallAngles) {
    const PointSpread spread(medium_, *intervals_, k_farthest);
    const std::size_t last = spread.distances().size() - 1;
    EXPECT_EQ(spread.distances()[last], k_farthest);
    for (const std::size_t band : {0U, 1U}) {
        const double all = std::expm1(b(band) * k_farthest);
        for (const std::size_t i : {8U, 20U, 24U, 28U, 32U, 36U, 40U, 48U}) {
            const double k = PointSpread::frequency(i);
            const double exponent = exponent_of(b(band) * k_farthest, k);
            // The tolerance is a fraction of the whole, for frequencies a quarter of an octave
            // apart and four nodes in each interval.
            EXPECT_NEAR(transfer(spread, 0, band, last, i), std::expm1(exponent), 0.002 * all)
                << "k " << k << ", band " << band;
        }
    }
}

// If a phase function diverges in its forward direction, a third of the scattering may be below
// 1e-5 rad. At the lowest frequency the transfer function contains everything that is scattered by
// less than 1 rad.
TEST_F(PointSpreads, ContainTheSteepestForwardPeaks) {
    const double n = 1.05;
    for (const double mu : {3.1, 3.5835, 4.5}) {
        medium_.phase_functions = {fournier_forand(n, mu)};
        const PointSpread spread(medium_, *intervals_, k_farthest);
        // Integrated by steps of the cumulative scattering in closed form (Fournier and Jonasz
        // 1999).
        const double nu = (3 - mu) / 2, d180 = 4 / (3 * (n - 1) * (n - 1));
        const auto fraction_below = [&](double psi) {
            const double s = std::sin(psi / 2), d = d180 * s * s;
            return ((1 - std::pow(d, nu + 1)) - (1 - std::pow(d, nu)) * s * s) /
                       ((1 - d) * std::pow(d, nu)) +
                   (1 - std::pow(d180, nu)) / (8 * (d180 - 1) * std::pow(d180, nu)) *
                       std::cos(psi) * std::sin(psi) * std::sin(psi);
        };
        constexpr int k_steps = 2001;
        double small_angles = fraction_below(1e-6);
        for (int i = 0; i < k_steps; ++i) {
            const double begin = std::pow(1e-6, 1 - static_cast<double>(i) / k_steps);
            const double end = std::pow(1e-6, 1 - static_cast<double>(i + 1) / k_steps);
            const double middle = std::sqrt(begin * end);
            small_angles +=
                (fraction_below(end) - fraction_below(begin)) * middle / std::sin(middle);
        }
        EXPECT_GT(fraction_below(1e-5), mu < 3.2 ? 0.3 : 0);
        const std::size_t last = spread.distances().size() - 1;
        for (const std::size_t band : {0U, 1U}) {
            const double truth = std::expm1(b(band) * k_farthest * small_angles);
            EXPECT_NEAR(transfer(spread, 0, band, last, 0), truth, 0.002 * truth) << mu;
        }
    }
}

// The sum of the intervals from any distance on is the transfer function of the water from there to
// the surface, times that of the water in front of it: exp(x_1 + x_2) - 1 = (exp(x_1) - 1) exp(x_2)
// + (exp(x_2) - 1).
TEST_F(PointSpreads, SplitLightByTheScatteringNearestToTheCamera) {
    const PointSpread spread(medium_, *intervals_, k_farthest);
    const std::size_t last = spread.distances().size() - 1;
    const std::size_t half = spread.interval_count() / 2;
    const double behind = k_farthest - intervals_->begin(half);
    for (const std::size_t i : {28U, 36U, 48U}) {
        const double exponent =
            exponent_of(b(1) * behind, PointSpread::frequency(i) * behind / k_farthest);
        EXPECT_NEAR(transfer(spread, half, 1, last, i), std::expm1(exponent),
                    0.002 * std::expm1(b(1) * behind));
    }
}

TEST_F(PointSpreads, LeaveOutWaterBehindTheSurfaceAndSurfacesThatAreTooFaint) {
    const PointSpread spread(medium_, *intervals_, k_farthest);
    const std::size_t half = spread.interval_count() / 2;
    const auto distances = spread.distances();
    for (std::size_t d = 0; d < distances.size(); ++d) {
        if (distances[d] > intervals_->begin(half)) continue;
        for (const float value : spread.transfer(half, 0, d)) EXPECT_EQ(value, 0);
    }
    medium_.uniform.scattering[0][1] = 1000;  // e^3000 overflows
    const PointSpread turbid(medium_, *intervals_, k_farthest);
    for (std::size_t i = 0; i < turbid.interval_count(); ++i) {
        for (std::size_t d = 0; d < distances.size(); ++d)
            for (const float value : turbid.transfer(i, 1, d)) EXPECT_TRUE(std::isfinite(value));
        for (const float value : turbid.transfer(i, 1, distances.size() - 1)) EXPECT_EQ(value, 0);
    }
}

}  // namespace
}  // namespace uw::test
