// ctest labels: analytic statistical
// Conservation of energy: the sum of the light that lamps emit.
#include <gtest/gtest.h>

#include "tests/support/paths/closed_form_surfaces.h"
#include "tests/support/paths/mean_fluence.h"

namespace uw::test {
namespace {

// A lamp in a black sphere of absorbing and scattering water: light scattered n times is absorbed,
// scattered again, or arrives at the wall.
TEST(PathEnergy, ScatteredLightIsAbsorbedOrArrives) {
    constexpr double pi = std::numbers::pi, k_radius = 2;
    PathScene scene({{0.2, 0.6}, {0.01, 1.5}}, 0.8);
    auto wall = std::make_unique<ClosedFormSurfaces>();
    wall->add_sphere({0, 0, 0}, k_radius, {});
    scene.surfaces = std::move(wall);
    scene.add_lamp({0.4, -0.3, 0.6}, 1);
    const PathTracer tracer(scene.lit());

    // Fluence integrated over the volume, and irradiance over the wall's area.
    constexpr std::size_t k_batches = 32;
    constexpr int k_points = 1 << 10;
    constexpr std::uint32_t k_paths = 8;
    const auto random_direction = [](std::mt19937_64& engine) {
        std::uniform_real_distribution<double> uniform;
        const double z = 2 * uniform(engine) - 1, phi = 2 * pi * uniform(engine);
        return Vector3(std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi),
                       z);
    };
    const double volume = 4 / 3.0 * pi * std::pow(k_radius, 3);
    const auto in_water = run_batches(k_batches, 2, 1, [&](std::uint64_t seed, TermSums& sums) {
        std::mt19937_64 engine(seed);
        std::uniform_real_distribution<double> uniform;
        for (int i = 0; i < k_points; ++i) {
            const Point3 x =
                at_origin_plus(k_radius * std::cbrt(uniform(engine)) * random_direction(engine));
            add_fluence(scene.lit(), tracer, x, (i + uniform(engine)) / k_points, uniform(engine),
                        engine(), k_paths, volume / k_points, sums);
        }
    });
    const double area = 4 * pi * k_radius * k_radius;
    const auto on_wall = run_batches(k_batches, 2, 2, [&](std::uint64_t seed, TermSums& sums) {
        std::mt19937_64 engine(seed);
        std::uniform_real_distribution<double> uniform;
        for (int i = 0; i < k_points; ++i) {
            const Vector3 normal = -random_direction(engine);
            const Point3 x = at_origin_plus(-(1 - 1e-9) * k_radius * normal);
            const FluenceDirection direction = fluence_direction(
                scene.lit(), x, (i + uniform(engine)) / k_points, uniform(engine));
            const double cosine = glm::dot(direction.ray.direction, normal);
            if (cosine > 0)
                trace_ray(tracer, *scene.surfaces, direction.ray, engine(), k_paths, sums,
                          cosine * direction.solid_angle * area / k_points);
        }
    });
    Deviations deviations;
    for (const std::size_t b : {0U, 1U}) {
        const double absorption = scene.medium.uniform.absorption[b];
        const double scattering = scene.medium.uniform.scattering[0][b];
        const double c = absorption + scattering;
        const auto of = [&](const std::vector<TermSums>& batches, int first, int last) {
            return means_of(batches, [&](const TermSums& sums) {
                return sums.sum(b, [&](int s, int, bool) { return s >= first && s <= last; });
            });
        };
        // The part of the lamp's 4 pi W that is scattered before it reaches the wall.
        double once = 0;
        constexpr int k_steps = 200;
        for (int i = 0; i < k_steps; ++i)
            for (int j = 0; j < k_steps; ++j) {
                const double z = 2 * (i + 0.5) / k_steps - 1, phi = 2 * pi * (j + 0.5) / k_steps;
                const Vector3 w(std::sqrt(1 - z * z) * std::cos(phi),
                                std::sqrt(1 - z * z) * std::sin(phi), z);
                const double length = scene.surfaces->hit_distance({scene.lamps[0].position(), w});
                once += 4 * pi / (k_steps * k_steps) * scattering / c * (1 - std::exp(-c * length));
            }
        const auto add = [&](const std::string& what, double in, double in_error, double out,
                             double out_error) {
            deviations.add(what, out, std::hypot(in_error, out_error), in);
        };
        for (int n = 1; n <= 3; ++n) {
            const BatchMeans before = of(in_water, n - 1, n - 1), fluence = of(in_water, n, n),
                             arriving = of(on_wall, n, n);
            add("order " + std::to_string(n), n == 1 ? once : scattering * before.mean(),
                n == 1 ? 0 : scattering * before.error(), c * fluence.mean() + arriving.mean(),
                std::hypot(c * fluence.error(), arriving.error()));
        }
        const BatchMeans fluence = of(in_water, 1, 100), arriving = of(on_wall, 1, 100);
        add("all", once, 0, absorption * fluence.mean() + arriving.mean(),
            std::hypot(absorption * fluence.error(), arriving.error()));
    }
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.04);
}

}  // namespace
}  // namespace uw::test
