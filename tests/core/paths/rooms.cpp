// ctest labels: analytic statistical slow
// Light in closed rooms, where its sum is known, and around emissive surfaces.
#include <gtest/gtest.h>

#include "tests/support/paths/closed_form_surfaces.h"
#include "tests/support/paths/ray_batches.h"

namespace uw::test {
namespace {

// In an integrating sphere each reflection illuminates the wall uniformly: light reflected n times
// and more is rho^n of the lamp's power, over the area. The water is clear.
TEST(ClosedRooms, AnIntegratingSphereIsEvenlyLitByEachReflection) {
    constexpr double k_radius = 1.5, k_intensity = 2;
    PathScene scene({{0, 0}, {0, 0}}, 0.9);
    const double reflectances[] = {0.5, 0.8};
    auto wall = std::make_unique<ClosedFormSurfaces>();
    wall->add_sphere({0.2, 0, 1}, k_radius, {{reflectances[0], reflectances[1]}, {}});
    scene.surfaces = std::move(wall);
    scene.add_lamp({0.5, -0.3, 0.4}, k_intensity);
    const auto batches = ray_batches(scene, {{0, 0, 0}, {0, 0.6, 0.8}}, 3);
    Deviations deviations;
    for (const std::size_t band : {0U, 1U}) {
        // Irradiance is power over area; radiance is exitance over pi.
        const double irradiance = k_intensity / (k_radius * k_radius);
        const double rho = reflectances[band];
        for (int n = 2; n <= 3; ++n)
            deviations.add("reflections " + std::to_string(n),
                           means_of(batches,
                                    [&](const TermSums& sums) {
                                        return sums.sum(band,
                                                        [&](int, int r, bool) { return r == n; });
                                    }),
                           irradiance * std::pow(rho, n) / std::numbers::pi);
        deviations.add("all",
                       means_of(batches, [&](const TermSums& sums) { return sums.total(band); }),
                       irradiance * rho * rho / (1 - rho) / std::numbers::pi);
    }
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.01);
}

/// A white furnace: where everything emits what it does not reflect, the radiance is the same
/// everywhere, also with lamps so faint that they add nothing.
struct FaintLamp {
    double intensity;  // below 0: there is no lamp
    std::uint32_t paths;
    double error;  // maximum error
};
class WhiteFurnaces : public testing::TestWithParam<FaintLamp> {};

TEST_P(WhiteFurnaces, AreWhiteInEveryDirection) {
    PathScene scene({{0, 0.3}, {0, 1.0}, {0, 2.0}}, 0.8);
    const FaintLamp& lamp = GetParam();
    if (lamp.intensity >= 0) scene.add_lamp({0.1, -0.2, 0.3}, lamp.intensity);
    const auto emissive = [](double a, double b, double c) {
        ClosedFormSurfaces::Material material{{a, b, c}, {}};
        material.more.emission = Spectrum{1 - a, 1 - b, 1 - c};
        return material;
    };
    auto room = std::make_unique<ClosedFormSurfaces>();
    room->add_box({-1, -1.5, -1}, {1, 1, 2}, emissive(0.5, 0.5, 0.2));
    room->add_sphere({0.4, 0.3, 1}, 0.4, emissive(0.8, 0.2, 0.7));
    room->add_box({-0.9, -1.2, 0.2}, {-0.3, -0.1, 0.9}, emissive(0.1, 0.6, 0.3));
    scene.surfaces = std::move(room);
    const PathTracer tracer(scene.lit());
    Deviations deviations;
    int number = 0;
    for (const Vector3& direction :
         {Vector3(0.4, 0.3, 1), Vector3(-0.6, -0.6, 0.5), Vector3(0.1, -0.2, -1),
          Vector3(0.7, -1, 0.2), Vector3(0.31, -0.1, 1)}) {
        const Ray ray{{0, 0, 0}, glm::normalize(direction)};
        SurfaceHit hit;
        ASSERT_TRUE(scene.surfaces->closest_hit(ray, k_far, hit));
        ++number;
        const auto batches =
            ray_batches(scene, ray, static_cast<std::uint64_t>(number), 32, lamp.paths);
        for (std::size_t b = 0; b < 3; ++b) {
            const double emitted = scene.surfaces->material(hit).emission[b] *
                                   std::exp(-scene.medium.uniform.attenuation(b) * hit.distance);
            deviations.add(
                "direction " + std::to_string(number) + " band " + std::to_string(b),
                means_of(batches, [&](const TermSums& sums) { return emitted + sums.total(b); }),
                1);
        }
    }
    deviations.expect_within_errors();
    deviations.expect_errors_below(lamp.error);
}

// No lamp, one that is switched off, and a faint one, which misguides paths.
INSTANTIATE_TEST_SUITE_P(Lamps, WhiteFurnaces,
                         testing::Values(FaintLamp{-1, 1 << 12, 0.01}, FaintLamp{0, 1 << 10, 0.02},
                                         FaintLamp{1e-12, 1 << 8, 0.04}));

// The reflectance of a rough surface under uniform light: the glTF 2.0 BRDF (appendix B) written
// again, integrated over all directions of light. GGX without multiple reflections between facets
// loses some energy.
class RoughSurface {
  public:
    RoughSurface(double cosine, double roughness, double f0, double rho)
        : to_camera_(std::sqrt(1 - cosine * cosine), 0, cosine),
          alpha2_(std::pow(roughness, 4)),
          f0_(f0),
          rho_(rho) {}

    /// The integral of BRDF times cosine, in spherical coordinates around the mirror direction,
    /// where the lobe is: angle pi t^3.
    double reflectance() const {
        using std::numbers::pi;
        const Vector3 mirror(-to_camera_.x, 0, to_camera_.z), u(to_camera_.z, 0, to_camera_.x),
            v(0, 1, 0);
        constexpr int k_rings = 1500, k_sectors = 400;
        double sum = 0;
        for (int i = 0; i < k_rings; ++i) {
            const double t = (i + 0.5) / k_rings, theta = pi * t * t * t;
            for (int j = 0; j < k_sectors; ++j) {
                const double phi = 2 * pi * (j + 0.5) / k_sectors;
                const Vector3 light = std::cos(theta) * mirror +
                                      std::sin(theta) * (std::cos(phi) * u + std::sin(phi) * v);
                if (light.z > 0) sum += brdf(light) * light.z * std::sin(theta) * 3 * pi * t * t;
            }
        }
        return sum * 2 * pi / (k_rings * k_sectors);
    }

  private:
    double brdf(const Vector3& to_light) const {
        const Vector3 half = glm::normalize(to_light + to_camera_);
        const double spread = half.z * half.z * (alpha2_ - 1) + 1;
        const double d = alpha2_ / (std::numbers::pi * spread * spread);
        const auto lambda = [&](double z) {  // Smith's function of a direction
            return 0.5 * (std::sqrt(1 + alpha2_ * (1 - z * z) / (z * z)) - 1);
        };
        const double g = 1 / (1 + lambda(to_light.z) + lambda(to_camera_.z));
        const double fresnel = f0_ + (1 - f0_) * std::pow(1 - glm::dot(half, to_camera_), 5);
        return (1 - fresnel) * rho_ / std::numbers::pi +
               fresnel * d * g / (4 * to_light.z * to_camera_.z);
    }

    Vector3 to_camera_;
    double alpha2_, f0_, rho_;
};

TEST(ClosedRooms, AShiningSurfaceReflectsTheIntegralOfItsBrdf) {
    struct Case {
        double cosine, roughness, f0, rho;
    };
    Deviations deviations;
    for (const Case& c : {Case{0.9, 0.3, 1, 0}, Case{0.3, 0.3, 1, 0}, Case{0.7, 0.6, 0.05, 0.6},
                          Case{0.2, 0.8, 0.9, 0.1}, Case{0.8, 1.0, 1, 0}}) {
        // A black room that emits a radiance of 1, and in it a box that does not; clear water.
        PathScene scene({{0, 0}}, 0.9);
        auto room = std::make_unique<ClosedFormSurfaces>();
        room->add_sphere({0, 0, 0}, 5, {{}, {.emission = {1}}});
        room->add_box({-1, -1, -1}, {1, 1, 0}, {{c.rho}, {{}, true, c.roughness, {c.f0}}});
        scene.surfaces = std::move(room);
        const Vector3 to_camera(std::sqrt(1 - c.cosine * c.cosine), 0, c.cosine);
        const auto batches =
            ray_batches(scene, {Point3{0.1, 0.2, 0} + 2.0 * to_camera, -to_camera}, 1);
        const std::string what =
            "cosine " + std::to_string(c.cosine) + " roughness " + std::to_string(c.roughness);
        const double reflectance = RoughSurface(c.cosine, c.roughness, c.f0, c.rho).reflectance();
        deviations.add(what, means_of(batches, [](const TermSums& sums) { return sums.total(0); }),
                       reflectance);
        // The same by the paths of mirrored light, which no lamp guides.
        const PathTracer tracer(scene.lit());
        SurfaceSample sample{{Point3{0.1, 0.2, 0} + 2.0 * to_camera, -to_camera}, {}, 0, 0};
        ASSERT_TRUE(scene.surfaces->closest_hit(sample.ray, k_far, sample.hit));
        const auto mirrored = run_batches(32, 1, 2, [&](std::uint64_t seed, TermSums& sums) {
            constexpr std::uint32_t k_paths = 1 << 11;
            sums.set_weight(1.0 / k_paths);
            PathScratch scratch;
            for (std::uint32_t i = 0; i < k_paths; ++i) {
                PathRandom random(seed, i);
                tracer.trace_mirrored(sample, random, sums, scratch);
            }
        });
        deviations.add(what + " mirrored",
                       means_of(mirrored, [](const TermSums& sums) { return sums.total(0); }),
                       reflectance);
    }
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.01);
}

}  // namespace
}  // namespace uw::test
