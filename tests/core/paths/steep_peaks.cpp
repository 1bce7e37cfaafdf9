// ctest labels: analytic statistical
// Phase functions that diverge in their forward direction, or nearly: the sampled directions and
// the tables down to the smallest angles, and the light next to a sun's direction.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/light/lamp.h"
#include "core/paths/guiding_distribution.h"
#include "core/paths/path_tracer.h"
#include "core/paths/scattering_tables.h"
#include "tests/support/paths/batch_means.h"
#include "tests/support/paths/path_scene.h"
#include "tests/support/paths/term_sums.h"
#include "tests/support/phase_function_laws.h"

namespace uw::test {
namespace {

using std::numbers::pi;

/// The fraction of the scattering below `psi` in closed form.
struct PeakedPhase {
    std::shared_ptr<const PhaseFunction> phase;
    std::function<double(double psi)> fraction_below;
};

// Fournier and Jonasz (1999), with the second term of p integrated by hand.
double fournier_forand_below(double n, double mu, double psi) {
    const double nu = (3 - mu) / 2, d180 = 4 / (3 * (n - 1) * (n - 1));
    const double s = std::sin(psi / 2), d = d180 * s * s;
    return ((1 - std::pow(d, nu + 1)) - (1 - std::pow(d, nu)) * s * s) /
               ((1 - d) * std::pow(d, nu)) +
           (1 - std::pow(d180, nu)) / (8 * (d180 - 1) * std::pow(d180, nu)) * std::cos(psi) *
               std::sin(psi) * std::sin(psi);
}

// (1 - g^2) / (2 g) (1 / (1 - g) - 1 / sqrt(1 + g^2 - 2 g cos psi)), without cancellation.
double henyey_greenstein_below(double g, double psi) {
    const double s = std::sin(psi / 2), near = 1 - g;
    const double far = std::sqrt(near * near + 4 * g * s * s);
    return (1 + g) * 2 * s * s / (far * (near + far));
}

std::vector<PeakedPhase> peaked_phases() {
    std::vector<PeakedPhase> phases;
    for (const double n : {1.02, 1.1, 1.2})
        for (const double mu : {3.1, 3.5835, 4.5})
            phases.push_back({fournier_forand(n, mu),
                              [=](double psi) { return fournier_forand_below(n, mu, psi); }});
    for (const double g : {0.9, 0.99, 0.9999})
        phases.push_back(
            {henyey_greenstein(g), [=](double psi) { return henyey_greenstein_below(g, psi); }});
    // Measured at two angles: p ~ psi^-1.9, the steepest that a table extrapolates, constant below
    // 1e-6.
    const SampledCurve steep{{0.1, 180}, {std::pow(1800, 1.9), 1}};
    const auto table = std::make_shared<const TabulatedPhase>(steep, "steep");
    phases.push_back({table, [table](double psi) {
                          const double even = std::sin(std::min(psi, 1e-6) / 2);
                          const double core = 4 * pi * even * even * table->eval(0);
                          if (psi <= 1e-6) return core;
                          return core + AdaptiveQuadrature::integrate(
                                            [&](double u) {
                                                const double at = std::exp(u);
                                                return 2 * pi * table->eval(at) * std::sin(at) * at;
                                            },
                                            std::log(1e-6 * (1 + 1e-12)), std::log(psi), 1e-10);
                      }});
    return phases;
}

Medium medium_with(const std::shared_ptr<const PhaseFunction>& phase) {
    Medium medium;
    medium.wavelengths_nm = {550};
    medium.phase_functions = {phase};
    medium.uniform.scattering.resize(1);
    medium.uniform.scattering[0][0] = 1;
    return medium;
}

// Tables of 64 parabolas per octave are accurate to 1e-6, but for kinks. Those of 16 straight lines
// are off by (ln 2 / 16)^2 / 12 = 1.6e-4 of the second derivative of the density by the logarithm
// of h, which is a few times the density.
TEST(SteepPeaks, TablesContainAllOfTheScattering) {
    for (const PeakedPhase& peaked : peaked_phases()) {
        SCOPED_TRACE(peaked.phase->description());
        const Medium medium = medium_with(peaked.phase);
        const PhaseTable table(medium);
        EXPECT_NEAR(integral_over_sphere([&](double psi) {
                        const double h = std::tan(psi / 2);
                        double p = 0;
                        table.eval(std::span(&h, 1), std::span(&p, 1));
                        return p;
                    }),
                    1, 1e-4);
        const ScatteringTables tables(medium);
        const HalfTangentDensity& density = tables.directions[0];
        EXPECT_NEAR(density.mass(), 1, 1e-3);
        for (double psi = 1.01e-6; psi < 3; psi *= 1.7)
            EXPECT_NEAR(density.mass_to(std::tan(psi / 2)) / density.mass(),
                        peaked.fraction_below(psi), 1e-3)
                << psi;
    }
}

// Sampled directions by their angle to the axis, in octaves, against the closed form: chi-square
// over n bins has the standard deviation sqrt(2 n); 4 of them are allowed. The smallest angles
// would lose digits if a direction were computed from the cosine.
TEST(SteepPeaks, DirectionsAreDrawnDownToTheSmallestAngles) {
    constexpr int k_draws = 200000, k_max_bins = 24;
    const Vector3 axis = glm::normalize(Vector3(0.3, -0.8, 0.5));
    for (const PeakedPhase& peaked : peaked_phases()) {
        SCOPED_TRACE(peaked.phase->description());
        const ScatteringTables tables(medium_with(peaked.phase));
        const HalfTangentDensity& density = tables.directions[0];
        std::vector<double> ends;
        for (double psi = 1.01e-6; psi < pi; psi *= 2) ends.push_back(psi);
        ends.push_back(pi);
        ASSERT_LE(ends.size(), static_cast<std::size_t>(k_max_bins));
        std::vector<int> counts(ends.size(), 0);
        for (int i = 0; i < k_draws; ++i) {
            PathRandom random(7, static_cast<std::uint32_t>(i));
            const double u = random.next(), azimuth = random.next();
            const Vector3 drawn = direction_around(axis, density.sample(u), azimuth);
            const double psi = 2 * std::atan(half_tangent_between(axis, drawn));
            const auto bin = std::ranges::lower_bound(ends, psi) - ends.begin();
            ++counts[std::min(static_cast<std::size_t>(bin), counts.size() - 1)];
        }
        double chi_square = 0, before = 0;
        int bins = 0, count = 0;
        double expected = 0;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const double below = peaked.fraction_below(ends[i]);
            expected += k_draws * (below - before);
            count += counts[i];
            before = below;
            if (expected < 20 && i + 1 < ends.size()) continue;  // rare ones are merged
            chi_square += (count - expected) * (count - expected) / std::max(expected, 1.0);
            ++bins;
            expected = count = 0;
        }
        EXPECT_LT(chi_square, bins + 4 * std::sqrt(2.0 * bins)) << bins;
    }
}

/// Plane irradiance below a sun at the zenith of infinite water that is lit from a plane on, by
/// scattered light that travels within an angle around the sun's direction: scattered once, twice,
/// and all orders.
struct NearSun {
    double absorption = 0.1, scattering = 0.5, depth = 4, within = pi / 180;
};
constexpr std::array<const char*, 3> k_orders{"once", "twice", "all"};
constexpr int k_sun_batches = 32;

// Single scattering: at the angle psi the light path back along a line of sight has a constant
// optical depth but for the slant.
double scattered_once(const NearSun& sun, const PeakedPhase& peaked) {
    const double c = sun.absorption + sun.scattering;
    constexpr int k_steps = 20000;
    double sum = 0, before = 0, psi = 1e-9;
    const double growth = std::pow(sun.within / psi, 1.0 / k_steps);
    for (int i = 0; i < k_steps; ++i, psi *= growth) {
        const double end = psi * growth, middle = std::sqrt(psi * end);
        const double below = peaked.fraction_below(end);
        const double slant = 2 * std::pow(std::sin(middle / 2), 2);  // 1 - cos psi
        const double length = -std::expm1(-c * slant * sun.depth / (1 - slant)) / (c * slant);
        sum += (below - before) * (1 - slant) * length;
        before = below;
    }
    return sun.scattering * std::exp(-c * sun.depth) * sum;
}

// Photons that start at the surface, scattered by the closed form alone, by batch.
std::array<BatchMeans, 3> by_photons(const NearSun& sun, const PeakedPhase& peaked) {
    constexpr int k_photons = 5000, k_angles = 1 << 14;
    // Angles at equal steps of the logarithm, and the fraction of the scattering below each.
    std::vector<double> angles, fractions;
    for (int i = 0; i <= k_angles; ++i) {
        angles.push_back(i == 0 ? 0
                                : 1e-9 * std::pow(pi / 1e-9, static_cast<double>(i) / k_angles));
        fractions.push_back(i == 0 ? 0 : i == k_angles ? 1 : peaked.fraction_below(angles.back()));
    }
    std::array<std::array<double, 3>, k_sun_batches> sums{};
    parallel_for(sums.size(), [&](std::size_t batch) {
        for (int i = 0; i < k_photons; ++i) {
            PathRandom random(PathRandom::seed_of(11, batch, 0), static_cast<std::uint32_t>(i));
            Vector3 direction(0, -1, 0);
            double depth = 0, weight = 1;
            for (int order = 0; order < 60; ++order) {
                const double length = -std::log1p(-random.next()) / sun.scattering;
                const double end = depth - length * direction.y;
                if (order > 0 && depth < sun.depth && end >= sun.depth &&
                    -direction.y > std::cos(sun.within)) {
                    const double arriving =
                        weight * std::exp(-sun.absorption * (sun.depth - depth) / -direction.y);
                    if (order <= 2) sums[batch][static_cast<std::size_t>(order) - 1] += arriving;
                    sums[batch][2] += arriving;
                }
                depth = end;
                weight *= std::exp(-sun.absorption * length);
                if (std::abs(depth) > 40) break;
                const double u = random.next();
                const auto at = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
                    std::ranges::upper_bound(fractions, u) - fractions.begin(), 1, k_angles));
                const double t = (u - fractions[at - 1]) / (fractions[at] - fractions[at - 1]);
                const double psi = angles[at - 1] + t * (angles[at] - angles[at - 1]);
                direction = direction_around(direction, std::tan(psi / 2), random.next());
            }
        }
    });
    std::array<BatchMeans, 3> means;
    for (const auto& batch : sums)
        for (std::size_t k = 0; k < means.size(); ++k) means[k].add(batch[k] / k_photons);
    return means;
}

// Light paths from a point, in directions sampled by the phase function around the sun.
std::array<BatchMeans, 3> by_paths(const NearSun& sun, const PeakedPhase& peaked) {
    constexpr int k_rays = 250;
    PathScene scene({{sun.absorption, sun.scattering}}, 0);
    scene.medium.phase_functions = {peaked.phase};
    const WaterSurfaceDesc surface{{0, 0, 0}, {0, 1, 0}, {}};
    scene.lamps = {Lamp("sun", Sunlight{{0, -1, 0}, surface}, Spectrum{1})};
    const PathTracer tracer(scene.lit());
    const HalfTangentDensity& density = tracer.scattering().directions[0];
    const double most = density.mass_to(std::tan(sun.within / 2));
    std::array<std::array<double, 3>, k_sun_batches> sums{};
    parallel_for(sums.size(), [&](std::size_t batch) {
        CameraSegment segment;
        TermSums terms(1);
        for (int i = 0; i < k_rays; ++i) {
            PathRandom random(PathRandom::seed_of(5, batch, 0), static_cast<std::uint32_t>(i));
            const double h = density.invert(random.next() * most);
            const Vector3 towards = direction_around({0, 1, 0}, h, random.next());
            tracer.begin({{0, -sun.depth, 0}, towards}, nullptr, {}, segment);
            terms.set_weight(towards.y * most / (density.density(h) * per_solid_angle(h)));
            tracer.trace_single(segment, random, terms);
            tracer.trace_water(segment, random, terms);
        }
        sums[batch] = {terms.order(0, 1), terms.order(0, 2), terms.total(0)};
    });
    std::array<BatchMeans, 3> means;
    for (const auto& batch : sums)
        for (std::size_t k = 0; k < means.size(); ++k) means[k].add(batch[k] / k_rays);
    return means;
}

TEST(SteepPeaks, LightNextToTheSunIsComplete) {
    const NearSun sun;
    Deviations deviations;
    const std::vector<PeakedPhase> phases = peaked_phases();
    for (const std::size_t i : {3U, 4U, 10U}) {  // Fournier-Forand's, and g = 0.99
        const PeakedPhase& peaked = phases[i];
        const std::array<BatchMeans, 3> paths = by_paths(sun, peaked),
                                        photons = by_photons(sun, peaked);
        const std::string what = peaked.phase->description() + ", ";
        // The paths' tables of phase functions are accurate to 1e-4.
        const double once = scattered_once(sun, peaked);
        deviations.add(what + "once, in closed form", paths[0], once, 1e-4 * once);
        for (std::size_t k = 0; k < k_orders.size(); ++k)
            deviations.add(what + k_orders[k], paths[k], photons[k].mean(), photons[k].error());
    }
    deviations.expect_within_errors();
    // One or two per cent of the light are at angles that a wrong table would omit.
    deviations.expect_errors_below(0.015, "all");
}

}  // namespace
}  // namespace uw::test
