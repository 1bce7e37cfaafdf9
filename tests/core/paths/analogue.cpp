// ctest labels: statistical slow
// The fluence in small spheres of water with a cloud of particles, in front of a wall and around a
// box, against an analog random walk of counted photons.
#include <gtest/gtest.h>

#include "tests/support/gaussian_field.h"
#include "tests/support/geometry_descs.h"
#include "tests/support/paths/analogue_photons.h"
#include "tests/support/paths/mean_fluence.h"

namespace uw::test {
namespace {

using Analogue = AnaloguePhotons;

/// The water scatters forward, the cloud less so. The box's shadow falls on part of the cloud and
/// on the second detector; the third lies in the cloud, the last in front of the wall.
Analogue::Scene harbour() {
    Analogue::Scene scene;
    scene.water = {0.15, 0.35, 0.85};
    scene.cloud = {{0.6, 0.5, 1.7}, 0.3, {0.3, 2.0, 0.5}};
    scene.box = {{-0.5, -0.3, 1.0}, {-0.1, 0.3, 1.5}, 0.6};
    scene.wall = {3, 0.7};
    scene.source.position = {-1.2, -0.2, 0.4};
    scene.detectors = {{{0.6, -0.7, 0.8}, 0.35},
                       {{0.6, -0.1, 2.4}, 0.35},
                       {{0.6, 0.5, 1.7}, 0.3},
                       {{-1.3, 0.4, 2.6}, 0.35}};
    return scene;
}

/// The same lamp as the tracer uses: 1 W.
PathScene traced(const Analogue::Scene& from) {
    PathScene scene({{from.water.absorption, from.water.scattering}}, from.water.g);
    const Analogue::Optics& peak = from.cloud.peak;
    // Knots a fortieth of sigma apart, linear in between, are off by 1e-4 of the peak at most.
    scene.set_field(std::make_unique<GaussianField>(from.cloud.center, from.cloud.sigma, 1.0,
                                                    0.05 * from.cloud.sigma),
                    {{peak.absorption, peak.scattering}}, peak.g);
    scene.set_surfaces(
        {with_reflectance(box(from.box.min, from.box.max), from.box.reflectance, 1),
         with_reflectance(plane({0, 0, from.wall.z}, {0, 0, -1}), from.wall.reflectance, 1)});
    const Analogue::Source& source = from.source;
    if (source.axis == Vector3(0)) {
        scene.add_lamp(source.position, 1 / (4 * std::numbers::pi));
    } else {
        // cos^m is half at fwhm / 2.
        const double fwhm = 2 * glm::degrees(std::acos(std::pow(0.5, 1 / source.exponent)));
        scene.add_lamp(source.position, (source.exponent + 1) / (2 * std::numbers::pi),
                       CosineProfile({fwhm}, {{}, source.axis}));
    }
    return scene;
}

std::vector<TermSums> traced_fluence(const PathScene& scene, const Analogue::Sphere& detector,
                                     std::size_t batches, int directions, std::uint64_t seed) {
    const PathTracer tracer(scene.lit());
    const auto make_batch = [&](std::uint64_t batch_seed, TermSums& sums) {
        std::mt19937_64 engine(batch_seed);
        std::uniform_real_distribution<double> uniform;
        for (int i = 0; i < directions; ++i) {
            Vector3 v;  // in the unit sphere
            do {
                v = {2 * uniform(engine) - 1, 2 * uniform(engine) - 1, 2 * uniform(engine) - 1};
            } while (glm::dot(v, v) > 1);
            const double u = (i + uniform(engine)) / directions;  // stratified
            add_fluence(scene.lit(), tracer, detector.center + detector.radius * v, u,
                        uniform(engine), engine(), 8, 1.0 / directions, sums);
        }
    };
    return run_batches(batches, scene.band_count(), seed, make_batch);
}

/// Photons counted in independent batches, by kind of path.
std::vector<Analogue::Fluence> counted_fluence(const Analogue::Scene& scene, std::size_t batches,
                                               int photons) {
    std::vector<Analogue::Fluence> counts(batches);
    parallel_for(batches,
                 [&](std::size_t n) { counts[n] = Analogue(scene, 1000 + n).count(photons); });
    return counts;
}

void compare(const Analogue::Scene& scene, int photons, int directions) {
    constexpr std::size_t k_batches = 32;
    const auto counts = counted_fluence(scene, k_batches, photons);
    const PathScene tracer_scene = traced(scene);
    Deviations kinds, totals;
    for (std::size_t i = 0; i < scene.detectors.size(); ++i) {
        const auto sums =
            traced_fluence(tracer_scene, scene.detectors[i], k_batches, directions, 100 + i);
        const std::string where = "detector " + std::to_string(i);
        // (s, r); -1 matches any number
        const auto add = [&](int s, int r, Deviations& deviations) {
            const auto matches = [&](int scatterings, int reflections) {
                return (s < 0 || std::min(scatterings, Analogue::k_scatterings - 1) == s) &&
                       (r < 0 || std::min(reflections, Analogue::k_reflections - 1) == r);
            };
            BatchMeans counted;
            for (const Analogue::Fluence& count : counts) {
                double sum = 0;
                for (int m = 0; m < Analogue::k_scatterings; ++m)
                    for (int n = 0; n < Analogue::k_reflections; ++n)
                        if (matches(m, n))
                            sum +=
                                count[i][static_cast<std::size_t>(m)][static_cast<std::size_t>(n)];
                counted.add(sum);
            }
            // Counts of fewer than some 400 photons are not normally distributed.
            if (!(counted.error() < 0.05 * counted.mean())) return;
            const BatchMeans estimate = means_of(sums, [&](const TermSums& batch) {
                return batch.sum(0, [&](int m, int n, bool) { return matches(m, n); });
            });
            deviations.add(
                where + " scatterings " + std::to_string(s) + " reflections " + std::to_string(r),
                estimate, counted.mean(), counted.error());
        };
        for (int s = 0; s < Analogue::k_scatterings; ++s)
            for (int r = 0; r < Analogue::k_reflections; ++r) add(s, r, kinds);
        add(-1, -1, totals);
    }
    kinds.expect_within_errors();
    totals.expect_within_errors();
    totals.expect_errors_below(0.01);
}

TEST(AnaloguePhotons, AgreeWithPathsAroundABoxAWallAndACloud) {
    compare(harbour(), 800'000, 1 << 10);
}

TEST(AnaloguePhotons, AgreeWithPathsForACosineLampAndADenseForwardScatteringCloud) {
    Analogue::Scene scene = harbour();
    scene.source.axis = glm::normalize(Vector3(1, 0.2, 0.7));
    scene.source.exponent = 2;
    scene.water = {0.05, 0.25, 0.9};
    scene.cloud.peak = {0.2, 5.0, 0.9};
    compare(scene, 400'000, 1 << 11);
}

}  // namespace
}  // namespace uw::test
