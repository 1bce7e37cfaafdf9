// ctest labels: analytic statistical
// Single particles of marine snow in images (docs/snow.md).
#include <gtest/gtest.h>

#include "tests/support/snow/snow_scene.h"

namespace uw::test {
namespace {

/// Pixels off the axis look a little longer; the attenuation of all snow, added, is 1e-6 per metre.
constexpr double k_particle_tolerance = 1e-3;

TEST(SnowParticles, OneParticleIsAsBrightAsTheClosedFormSays) {
    for (const Vector3 about :
         {Vector3{0.4, 0.2, 1.5}, Vector3{-0.8, 0.3, 3}, Vector3{2, 1, 0.7}}) {
        SceneDesc desc = clear_scene();
        const SnowParticle particle = aim(desc, about);
        const Film film = image_of(desc);
        for (const std::size_t band : {0U, 1U, 2U}) {
            const Spot spot = spot_of(film, k_snow + band);
            EXPECT_NEAR(spot.sum / sum_of(particle, desc, band), 1, k_particle_tolerance);
        }
        EXPECT_NEAR(spot_of(film).x, 32, 0.05);
        EXPECT_NEAR(spot_of(film).y, 32, 0.05);
    }
}

TEST(SnowParticles, DefocusSpreadsLightOverTheCircleOfConfusion) {
    SceneDesc desc = clear_scene();
    const SnowParticle particle = aim(desc, {0.2, 0.1, 1.2});
    const double range = range_of(particle, desc);
    const double disk = 0.5 * particle.diameter / range * desc.camera.intrinsics.fx;
    LensDesc lens{.f_number = 2.8, .focal_length = 0.05};
    for (const double focus : {0.8 * range, range, 1.4 * range}) {
        lens.focus_distance = focus;
        desc.camera.lens = lens;
        desc.render.samples = 1;
        const Spot spot = spot_of(image_of(desc));
        const double aperture = 0.5 * 0.05 / 2.8;
        const double blur = desc.camera.intrinsics.fx * aperture * std::abs(1 / focus - 1 / range);
        EXPECT_NEAR(spot.sum / sum_of(particle, desc, 0), 1, k_particle_tolerance) << focus;
        // The variance of a disk is r^2/4 and that of a pixel 1/12; what is smaller than a pixel
        // fills those it touches.
        EXPECT_NEAR(spot.variance_x, 0.25 * (disk * disk + blur * blur) + 1.0 / 12,
                    0.02 * blur * blur + 0.1);
    }
}

TEST(SnowParticles, DriftDrawsParticlesOutWhileTheShutterIsOpen) {
    SceneDesc desc = clear_scene();
    const SnowParticle particle = aim(desc, {0.2, 0.1, 1.2});
    const double range = range_of(particle, desc);
    const Vector3 right = desc.camera.world_from_camera.apply_to_vector({1, 0, 0});
    desc.render.shutter = 0.02;
    desc.water.snow->drift = 0.6 * right;
    const double length = 0.6 * 0.02 / range * desc.camera.intrinsics.fx;
    ASSERT_GT(length, 10);
    const double disk = 0.5 * particle.diameter / range * desc.camera.intrinsics.fx;
    const Spot spot = spot_of(image_of(desc));
    EXPECT_NEAR(spot.sum / sum_of(particle, desc, 0), 1, k_particle_tolerance);
    EXPECT_NEAR(spot.variance_x, length * length / 12 + disk * disk / 4 + 1.0 / 12, 1);
    EXPECT_NEAR(spot.x, 32, 0.1);
}

/// A camera that moves draws out what stands still by the same amount.
TEST(SnowParticles, AMovingCameraDrawsParticlesOut) {
    SceneDesc desc = clear_scene();
    aim(desc, {0.2, 0.1, 1.2});
    desc.render.shutter = 0.02;
    SceneDesc drifts = desc;
    const Vector3 right = desc.camera.world_from_camera.apply_to_vector({1, 0, 0});
    drifts.water.snow->drift = 0.6 * right;
    std::vector<TimedPose> poses;
    for (const double t : {-1, 1})
        poses.push_back(
            {t, pose_of(Affine(desc.camera.world_from_camera.linear(),
                               desc.camera.world_from_camera.offset() - 0.6 * t * right))});
    TrajectoryDesc trajectory;
    trajectory.trajectory = std::make_shared<Trajectory>(poses, Interpolation::linear);
    desc.camera.trajectory = trajectory;
    const Film moving = image_of(desc), drifting = image_of(drifts);
    for (int x = 0; x < 64; ++x)
        EXPECT_NEAR(moving.pixel(x, 32)[k_snow], drifting.pixel(x, 32)[k_snow],
                    1e-3F * drifting.pixel(32, 32)[k_snow])
            << x;
}

TEST(SnowParticles, BoxesShadeAndHideParticles) {
    SceneDesc desc = clear_scene();
    const SnowParticle particle = aim(desc, {0.4, 0.2, 1.5});
    const Point3 lamp = desc.camera.world_from_camera * desc.lamps[0].position;
    const Point3 eye = centre_of(desc);
    const Vector3 half(0.02);
    const auto black_box_at = [&](const Point3& centre) {
        GeometryDesc found = box(centre - half, centre + half);
        found.reflectance = PerBand{0, 0, 0};
        return found;
    };
    const double lit = spot_of(image_of(desc)).sum;
    // The backscatter of the particles themselves beyond where they are drawn remains.
    SceneDesc shaded = desc;
    shaded.geometry = {black_box_at(lamp + 0.5 * (particle.position - lamp))};
    EXPECT_NEAR(spot_of(image_of(shaded)).sum, 0, 1e-6 * lit);
    SceneDesc hidden = desc;
    hidden.geometry = {black_box_at(eye + 0.5 * (particle.position - eye))};
    EXPECT_NEAR(spot_of(image_of(hidden)).sum, 0, 1e-6 * lit);
    SceneDesc before = desc;
    before.geometry = {black_box_at(eye + 1.5 * (particle.position - eye))};
    EXPECT_NEAR(spot_of(image_of(before)).sum, lit, 1e-3 * lit);
}

/// Both cameras of a rig see the same particles, where they are.
TEST(SnowParticles, TwoCamerasSeeTheSameParticle) {
    SceneDesc desc = clear_scene();
    const SnowParticle particle = aim(desc, {0.4, 0.2, 1.5});
    const Matrix3 axes = desc.camera.world_from_camera.linear();
    const Vector3 centre = desc.camera.world_from_camera.offset();
    const double range = range_of(particle, desc);
    for (const double offset : {-0.008, 0.008}) {
        desc.camera.world_from_camera = Affine(axes, centre + offset * axes[0]);
        const Spot spot = spot_of(image_of(desc));
        EXPECT_NEAR(spot.x, 32 - offset / range * desc.camera.intrinsics.fx, 0.05);
        EXPECT_NEAR(spot.y, 32, 0.05);
    }
}

/// In the next frame particles are where they drifted.
TEST(SnowParticles, ParticlesDriftFromFrameToFrame) {
    SceneDesc desc = clear_scene();
    const SnowParticle particle = aim(desc, {0.4, 0.2, 1.5});
    const Matrix3 axes = desc.camera.world_from_camera.linear();
    desc.water.snow->drift = 0.05 * axes[0] - 0.02 * axes[1];
    const double scale = desc.camera.intrinsics.fx / range_of(particle, desc);
    for (const int frame : {0, 2, 4}) {
        Renderer renderer;
        renderer.set_scene(scene_of_image(desc, {.frame = frame}));
        const Spot spot = spot_of(renderer.render({.layers = "snow"}));
        EXPECT_NEAR(spot.x, 32 + scale * 0.05 * frame / 25, 0.05);
        EXPECT_NEAR(spot.y, 32 - scale * 0.02 * frame / 25, 0.05);
    }
}

TEST(SnowParticles, GroundTruthHoldsParticlesIfAsked) {
    SceneDesc desc = clear_scene();
    desc.camera.intrinsics.fx = desc.camera.intrinsics.fy = 8000;  // 4 pixels
    const SnowParticle particle = aim(desc, {0.4, 0.2, 1.5});
    desc.geometry = {plane(particle.position + 20.0 * Vector3(0, 0, 1), {0, 0, -1})};
    const auto ranges_of = [&] {
        const Film film = image_of(desc, {.layers = "range,id"});
        return std::pair{static_cast<double>(film.pixel(32, 32)[4]), film.pixel(32, 32)[5]};
    };
    EXPECT_GT(ranges_of().first, 10);
    EXPECT_EQ(ranges_of().second, 1);
    desc.water.snow->in_ground_truth = true;
    EXPECT_NEAR(ranges_of().first, range_of(particle, desc), 1e-6);
    EXPECT_EQ(ranges_of().second, 2);
}

/// Particles whose centres the image shows: Poisson's count of all that are in its pyramid.
TEST(SnowParticles, DrawsAsManyParticlesAsAreInView) {
    SceneDesc desc = clear_scene();
    desc.camera.width = desc.camera.height = 400;
    desc.camera.intrinsics = {400, 400, 200, 200};
    desc.water.snow->number = 3000;
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc));
    renderer.render({.layers = "snow"});
    const double range = renderer.assembled().snow->ranges[0];
    // The solid angle of a square pyramid of half width 1/2: 4 asin(1/5).
    const double expected = 3000 * 4 * std::asin(0.2) * range * range * range / 3;
    // Those that reach over the edges are counted as well: a disk of a pixel at most.
    EXPECT_NEAR(static_cast<double>(renderer.report().snow_particles), expected,
                5 * std::sqrt(expected) + expected * 4 * 1.0 / 400);
    EXPECT_GT(expected, 10'000);
}

/// More particles than can be drawn one by one: the image says so and takes no longer.
TEST(SnowParticles, ABillionParticlesAreBounded) {
    SceneDesc desc = clear_scene();
    desc.camera.width = 320;
    desc.camera.height = 240;
    desc.camera.intrinsics = {300, 300, 160, 120};
    desc.water.snow->number = 1e9;
    desc.water.snow->least = 1e-5;
    desc.water.snow->greatest = 1e-3;
    desc.water.snow->most = 1000;
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc));
    renderer.render({.layers = "snow"});
    EXPECT_LT(renderer.report().snow_particles, 1500U);
    ASSERT_EQ(renderer.report().warnings.size(), 1U);
    EXPECT_NE(renderer.report().warnings[0].find("the others are their mean"), std::string::npos);
}

}  // namespace
}  // namespace uw::test
