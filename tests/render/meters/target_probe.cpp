// ctest labels: unit analytic metamorphic
#include "render/meters/target_probe.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "render/scene_loading.h"
#include "tests/support/adaptive_quadrature.h"
#include "tests/support/film_rendering.h"
#include "tests/support/message_of.h"
#include "tests/support/motion/moving_scene.h"

namespace uw::test {
namespace {

constexpr double k_g = 0.9;

SceneDesc two_lamps() {
    SceneDesc desc = pinhole_scene(30, 20);
    desc.geometry = {plane_at_z(1)};  // in the way, were it not replaced
    desc.lamps = {isotropic_lamp({-0.6, 0.1, 0}, 40), isotropic_lamp({0.8, 0, -0.2}, 25)};
    desc.lamps[1].name = "right";
    return desc;
}

/// The light of isotropic lamps on a white wall at z = `distance`, and of the water before it,
/// along the camera's ray in `direction`, by its formulas.
struct RayTruth {
    double signal = 0, backscatter = 0, irradiance = 0;

    RayTruth(const SceneDesc& desc, const Vector3& direction, double distance, std::size_t band) {
        const double b = desc.water.scattering->b[band];
        const double c = desc.water.absorption->at(band) + b;
        const double end = distance / direction.z;
        for (const LampDesc& lamp : desc.lamps) {
            const double intensity = lamp.intensity->at(band);
            const Vector3 wall = end * direction - from_origin(lamp.position);
            const double r = glm::length(wall);
            const double light = intensity / (r * r) * (wall.z / r) * std::exp(-c * r);
            irradiance += light;
            signal += light / M_PI * std::exp(-c * end);
            backscatter += AdaptiveQuadrature::integrate(
                [&](double s) {
                    const Vector3 from_lamp = s * direction - from_origin(lamp.position);
                    const double radius = glm::length(from_lamp);
                    const double cosine = -glm::dot(from_lamp, direction) / radius;
                    const double phase =
                        (1 - k_g * k_g) /
                        (4 * M_PI * std::pow(1 + k_g * k_g - 2 * k_g * cosine, 1.5));
                    return intensity / (radius * radius) * b * phase * std::exp(-c * (radius + s));
                },
                0.0, end, 1e-9);
        }
    }
};

TEST(TargetProbe, AgreesWithTheFormulasOfUniformWater) {
    const SceneDesc desc = two_lamps();
    const ImageScene scene{SceneDesc(desc)};
    TargetOptions options{.bright = 0.9, .dark = 0.05, .field = 0.6, .rays = 3};
    TargetProbe probe(options);
    for (const double distance : {0.5, 2.0, 6.0}) {
        SCOPED_TRACE(distance);
        double signal = 0, backscatter = 0, irradiance = 0;
        for (int i = 0; i < 9; ++i) {
            // Pixel centres of thirds of the middle 18 x 12 pixels.
            const double x = 6 + 18 * (i % 3 + 0.5) / 3, y = 4 + 12 * (i / 3 + 0.5) / 3;
            const IntrinsicsDesc& k = desc.camera.intrinsics;
            const Vector3 direction =
                glm::normalize(Vector3((x - k.cx) / k.fx, (y - k.cy) / k.fy, 1));
            for (std::size_t band = 0; band < 3; ++band) {
                const RayTruth truth(desc, direction, distance, band);
                signal += truth.signal / 27;
                backscatter += truth.backscatter / 27;
                irradiance += truth.irradiance / 27;
            }
        }
        const TargetNumbers numbers = probe.curve(scene, std::vector{distance}).front();
        EXPECT_EQ(numbers.distance, distance);
        // Closed forms, rounded to float.
        EXPECT_NEAR(numbers.signal, 0.9 * signal, 1e-6 * signal);
        EXPECT_NEAR(numbers.irradiance, irradiance, 1e-6 * irradiance);
        // The integrator's steps of 0.5 % of the distance from the lamp: measured 1e-5.
        EXPECT_NEAR(numbers.backscatter, backscatter, 1e-4 * backscatter);
        EXPECT_NEAR(numbers.contrast, 0.85 * signal / (0.95 * signal + 2 * backscatter), 1e-4);
        EXPECT_NEAR(numbers.signal_to_backscatter, 0.9 * signal / backscatter,
                    1e-4 * signal / backscatter);
    }
}

// Without scattering there is no veil: the contrast is that of the target itself.
TEST(TargetProbe, SeesTheTargetsOwnContrastInWaterThatOnlyAbsorbs) {
    for (const std::size_t bands : {1U, 3U, 8U}) {
        SceneDesc desc = two_lamps();
        desc.water.bands_nm.resize(bands);
        for (std::size_t b = 0; b < bands; ++b)
            desc.water.bands_nm[b] = 420 + 30 * static_cast<double>(b);
        desc.water.absorption = PerBand(bands, 0.1);
        desc.water.scattering->b = PerBand(bands, 0.0);
        for (LampDesc& lamp : desc.lamps) lamp.intensity = PerBand(bands, 10.0);
        const ImageScene scene{std::move(desc)};
        TargetProbe probe({.bright = 0.8, .dark = 0.2});
        for (const TargetNumbers& numbers : probe.curve(scene, target_distances(0.5, 10, 4))) {
            EXPECT_NEAR(numbers.contrast, 0.6, 1e-12);
            EXPECT_TRUE(std::isinf(numbers.signal_to_backscatter));
        }
    }
    // And nothing in the dark.
    SceneDesc dark = two_lamps();
    dark.lamps.clear();
    TargetProbe probe;
    EXPECT_EQ(probe.curve(ImageScene{std::move(dark)}, std::vector{1.0}).front().contrast, 0);
}

/// Two whole images, one of a bright wall and one of a dark one, rendered as users do, lamps of
/// every kind of brightness, through a port: the contrast is that of their means.
TEST(TargetProbe, AgreesWithImagesOfTheTarget) {
    SceneDesc desc = two_lamps();
    desc.camera.width = desc.camera.height = 5;
    desc.camera.intrinsics = {5, 5, 2.6, 2.3};
    desc.camera.distortion.k[0] = -0.05;
    desc.camera.port = FlatPortDesc{.normal = {0, 0, 1}, .distance = 0.02, .thickness = 0.02};
    desc.camera.world_from_camera =
        Affine::translation({1, 2, 3}) * Affine::rotation_xyz_degrees({10, 40, 5});
    desc.lamps[0].profile = SpotProfileDesc{.beam = 90, .edge = 20};
    desc.lamps[0].direction = glm::normalize(Vector3(0.2, 0, 1));
    desc.lamps[0].intensity.reset();
    desc.lamps[0].power = PerBand{30, 20, 10};
    desc.lamps[1].intensity.reset();
    desc.lamps[1].lumens = 5000;
    desc.lamps[1].spectrum = LampSpectrumDesc{};
    desc.geometry = {plane_at_z(0)};
    desc.geometry[0].point = desc.camera.world_from_camera * Point3{0, 0, 2.5};
    desc.geometry[0].normal = desc.camera.world_from_camera.apply_to_vector({0, 0, -1});
    const auto mean_of = [&](double reflectance) {
        desc.geometry[0].reflectance = PerBand(3, reflectance);
        const RenderedFilm film(desc);
        double sum = 0;
        for (int i = 0; i < 75; ++i) sum += film.total(i % 5, i / 5 % 5, i / 25);
        return sum / 75;
    };
    const double bright = mean_of(0.9), dark = mean_of(0.1);
    TargetProbe probe({.bright = 0.9, .dark = 0.1, .field = 1, .rays = 5});
    const TargetNumbers numbers =
        probe.curve(ImageScene{SceneDesc(desc)}, std::vector{2.5}).front();
    // The volume integrator's tolerance for in-scatter is 0.2 %.
    EXPECT_NEAR(numbers.contrast, (bright - dark) / (bright + dark), 1e-3);
    EXPECT_NEAR(numbers.signal + numbers.backscatter, bright, 1e-3 * bright);
}

TEST(TargetProbe, RendersOnlyWhatChanged) {
    SceneDesc desc = two_lamps();
    const std::vector<double> distances = target_distances(0.5, 10, 5);
    TargetProbe probe({.rays = 1});
    const auto curve = [&] { return probe.curve(ImageScene{SceneDesc(desc)}, distances); };
    const auto expect_as_new = [&](std::uint64_t rendered) {
        const std::uint64_t before = probe.rendered();
        const std::vector<TargetNumbers> numbers = curve();
        EXPECT_EQ(probe.rendered() - before, rendered);
        TargetProbe fresh({.rays = 1});
        const std::vector<TargetNumbers> expected =
            fresh.curve(ImageScene{SceneDesc(desc)}, distances);
        for (std::size_t i = 0; i < distances.size(); ++i) {
            EXPECT_EQ(numbers[i].contrast, expected[i].contrast);
            EXPECT_EQ(numbers[i].irradiance, expected[i].irradiance);
        }
    };
    expect_as_new(10);
    expect_as_new(0);
    desc.lamps[0].intensity = PerBand{1, 2, 3};
    desc.lamps[1].name = "other";
    desc.geometry.clear();
    expect_as_new(0);
    desc.lamps[1].position.x += 0.1;
    expect_as_new(5);
    desc.lamps[0].profile = SpotProfileDesc{.beam = 60, .edge = 5};
    expect_as_new(5);
    desc.lamps.pop_back();
    expect_as_new(0);
    desc.water.absorption = PerBand{0.5, 0.5, 0.5};
    expect_as_new(5);
    desc.camera.intrinsics.fx *= 1.1;
    expect_as_new(5);
    desc.lamps[0].intensity = PerBand{2, 4, 6};
    const std::vector<TargetNumbers> twice = curve();
    desc.lamps[0].intensity = PerBand{1, 2, 3};
    EXPECT_DOUBLE_EQ(twice[0].irradiance, 2 * curve()[0].irradiance);
}

// The same as in a scene that stands still as the moving one is at the image's moment, which is not
// the first at which it has poses.
TEST(TargetProbe, LooksFromWhereTheCameraIsAtTheImagesMoment) {
    const ImageScene moving = moving_scene("");
    SceneDesc still = moving.desc();
    still.camera.trajectory.reset();
    still.geometry.clear();
    for (LampDesc& lamp : still.lamps) lamp.trajectory.reset();
    const std::vector<double> distances{0.5, 3.0};
    TargetProbe probe({.rays = 1}), other({.rays = 1});
    const std::vector<TargetNumbers> found = probe.curve(moving, distances);
    const std::vector<TargetNumbers> expected =
        other.curve(ImageScene{std::move(still)}, distances);
    for (std::size_t i = 0; i < distances.size(); ++i) {
        EXPECT_GT(expected[i].contrast, 0);
        EXPECT_EQ(found[i].contrast, expected[i].contrast);
        EXPECT_EQ(found[i].irradiance, expected[i].irradiance);
        EXPECT_EQ(found[i].backscatter, expected[i].backscatter);
    }
}

TEST(TargetProbe, CanBeCancelledAndRefusesWhatMakesNoSense) {
    const ImageScene scene{two_lamps()};
    TargetProbe probe({.rays = 1});
    const std::vector<double> distances = target_distances();
    probe.curve(scene, std::span(distances).first(7));
    {
        const std::atomic<bool> stop = true;
        const StopScope scope(stop);
        EXPECT_THROW(probe.curve(scene, distances), Interrupted);
    }
    EXPECT_EQ(probe.rendered(), 14U);
    EXPECT_EQ(probe.curve(scene, distances).size(), 20U);
    EXPECT_EQ(probe.rendered(), 40U) << "what was rendered before is kept";
    EXPECT_NE(message_of<UsageError>([&] { probe.curve(scene, std::vector{0.0}); }), "");
    EXPECT_NE(message_of<UsageError>([&] { TargetProbe({.bright = 0.1, .dark = 0.2}); }), "");
    EXPECT_NE(message_of<UsageError>([&] { TargetProbe({.field = 0}); }), "");
    EXPECT_NE(message_of<UsageError>([&] { TargetProbe({.rays = 65}); }), "");
}

TEST(TargetDistances, GoInEqualRatios) {
    const std::vector<double> distances = target_distances(0.5, 8, 5);
    ASSERT_EQ(distances.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_DOUBLE_EQ(distances[i], 0.5 * std::pow(2, static_cast<double>(i)));
}

}  // namespace
}  // namespace uw::test
