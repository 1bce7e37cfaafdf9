// ctest labels: analytic statistical
// Images with glass: lamps behind panes, what is seen through panes and balls, and light paths that
// agree with the integrators.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/geometry/surface_reflection.h"
#include "tests/support/film_rendering.h"
#include "tests/support/fresnel_by_angles.h"
#include "tests/support/message_of.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr double k_glass_wall = 4, k_index = 1.52;

/// A wall that a lamp lights from the side, without glass, with single scattering.
SceneDesc scene_without_glass() {
    SceneDesc desc = pinhole_scene(24, 18);
    desc.geometry = {plane_at_z(k_glass_wall)};
    desc.lamps = {isotropic_lamp({1.5, 0.2, 1}, 5)};
    desc.lamps[0].fixed_to_camera = false;
    desc.render.scattering = RenderDesc::Scattering::single;
    return desc;
}

/// A thin pane across the camera's axis.
GeometryDesc pane_across(double z, GlassDesc glass) {
    GeometryDesc pane = plane_at_z(z);
    glass.is_thin = true;
    pane.glass = glass;
    return pane;
}

SceneDesc with(SceneDesc desc, GeometryDesc object) {
    desc.geometry.push_back(std::move(object));
    return desc;
}

double pane_transmittance(double angle) {
    const Polarised face = fresnel_by_angles(std::max(angle, 1e-6), k_surface_water_index, k_index);
    return 0.5 * (face.s / (2 - face.s) + face.p / (2 - face.p));
}

/// The ray of a pixel of scene_without_glass.
Vector3 direction_of(const SceneDesc& desc, int x, int y) {
    const auto& camera = desc.camera;
    return glm::normalize(Vector3((x + 0.5 - camera.intrinsics.cx) / camera.intrinsics.fx,
                                  (y + 0.5 - camera.intrinsics.cy) / camera.intrinsics.fy, 1));
}

TEST(GlassImages, PaneBeforeALampDimsItByItsTransmittance) {
    const SceneDesc desc = scene_without_glass();
    const Point3 lamp = desc.lamps[0].position;
    GeometryDesc pane;  // between the lamp and the wall, beside what the camera sees
    pane.type = GeometryDesc::Type::box;
    pane.min = {-9, -9, 3.99};
    pane.max = {9, 9, 3.9901};
    // Close to the wall, which all light passes once, and the camera's rays too: each face of this
    // box is a pane of its own.
    pane.glass = GlassDesc{.n = k_index, .is_thin = true, .absorption = {}};
    const RenderedFilm plain(desc), dimmed(with(desc, pane));
    for (const auto& [x, y] : {std::pair{12, 9}, std::pair{2, 3}, std::pair{22, 15}}) {
        const Vector3 direction = direction_of(desc, x, y);
        const Point3 on_wall = Point3{0, 0, 0} + k_glass_wall / direction.z * direction;
        const Vector3 from_lamp = glm::normalize(on_wall - lamp);
        const double t = std::pow(
            pane_transmittance(std::acos(from_lamp.z)) * pane_transmittance(std::acos(direction.z)),
            2);
        for (int b = 0; b < 3; ++b) {
            // What is reflected between the panes and from the water in front adds little to direct
            // light: the wall seen once more, by two reflections of 0.4 %.
            EXPECT_NEAR(
                dimmed.value(Layer::direct, x, y, b) / plain.value(Layer::direct, x, y, b) / t, 1,
                1e-4);
        }
    }
}

TEST(GlassImages, PaneOfTheWatersIndexIsInvisible) {
    for (const auto integrator :
         {RenderDesc::Integrator::volume, RenderDesc::Integrator::reference}) {
        SceneDesc desc = scene_without_glass();
        desc.render.integrator = integrator;
        desc.render.samples = 4;
        const RenderedFilm plain(desc),
            behind(with(desc, pane_across(2, {.n = k_surface_water_index, .absorption = {}})));
        EXPECT_LT(worst_difference(behind, plain, Layer::direct), 1e-5);
        // Each part of a ray has nodes of its own, and only that before the pane is interpolated
        // between pixels.
        EXPECT_LT(worst_difference(behind, plain, Layer::backscatter), 4e-3);
    }
}

TEST(GlassImages, ColouredPaneFiltersALampByBand) {
    SceneDesc desc = scene_without_glass();
    desc.lamps[0].position = {0.3, 0.2, -1};
    const PerBand absorption{100, 10, 1};
    const GeometryDesc pane = pane_across(
        -0.5, {.n = k_surface_water_index, .thickness = 0.01, .absorption = absorption});
    const RenderedFilm plain(desc), filtered(with(desc, pane));
    for (int b = 0; b < 3; ++b) {
        // The lamp's light at the middle of the wall passes the pane at 4.2 degrees at most.
        const double left = std::exp(-absorption[static_cast<std::size_t>(b)] * 0.01);
        EXPECT_NEAR(filtered.value(Layer::direct, 12, 9, b),
                    left * plain.value(Layer::direct, 12, 9, b),
                    4e-3 * left * plain.value(Layer::direct, 12, 9, b));
        EXPECT_NEAR(filtered.lamp(0, 12, 9, b), filtered.total(12, 9, b),
                    1e-6 * filtered.total(12, 9, b));
        EXPECT_LT(filtered.value(Layer::backscatter, 12, 9, b),
                  plain.value(Layer::backscatter, 12, 9, b));
    }
}

/// A ball of glass and a bubble before the wall, beside a pane.
SceneDesc scene_with_balls() {
    SceneDesc desc = scene_without_glass();
    GeometryDesc ball;
    ball.type = GeometryDesc::Type::sphere;
    ball.center = {-0.4, 0, 2};
    ball.radius = 0.4;
    ball.glass = GlassDesc{.n = k_index, .absorption = {2, 1, 0.5}};
    GeometryDesc bubble = ball;
    bubble.center = {0.6, 0.2, 2.2};
    bubble.radius = 0.35;
    bubble.glass = GlassDesc{.n = 1, .absorption = {}};
    desc.geometry.insert(desc.geometry.end(), {ball, bubble});
    return desc;
}

// They share neither the tree of rays nor the integration along them.
TEST(GlassImages, LightPathsSeeTheSameThroughBalls) {
    SceneDesc desc = scene_with_balls();
    desc.render.samples = 16;
    const RenderedFilm volume(desc);
    desc.render.integrator = RenderDesc::Integrator::path;
    desc.render.scattering.reset();
    desc.render.samples = 256;
    const RenderedFilm paths(desc);
    for (int b = 0; b < 3; ++b) {
        EXPECT_NEAR(volume.sum(Layer::direct, b) / paths.sum(Layer::direct, b), 1, 5e-3);
        EXPECT_NEAR(volume.sum(Layer::backscatter, b) / paths.sum(Layer::backscatter, b), 1, 5e-3);
    }
}

// Without the bubble: what it mirrors of the glow around the lamp reaches the wall as a few bright
// paths, which the nodes' smoothing spreads and a mean of 256 does not know.
TEST(GlassImages, FastFormOfMultipleScatteringAgreesWithPaths) {
    SceneDesc desc = scene_with_balls();
    desc.geometry.pop_back();
    desc.render.scattering = RenderDesc::Scattering::multiple;
    desc.render.samples = 16;
    const RenderedFilm volume(desc);
    desc.render.integrator = RenderDesc::Integrator::path;
    desc.render.samples = 256;
    const RenderedFilm paths(desc);
    for (int b = 0; b < 3; ++b)
        for (const Layer layer : {Layer::multiple_volume, Layer::multiple_surface})
            EXPECT_NEAR(volume.sum(layer, b) / paths.sum(layer, b), 1, 0.03)
                << "band " << b << (layer == Layer::multiple_volume ? " volume" : " surface");
}

TEST(GlassImages, RefuseWhatKnowsNoGlass) {
    SceneDesc desc = scene_with_balls();
    desc.render.integrator = RenderDesc::Integrator::planes;
    EXPECT_EQ(
        message_of<InputError>([&] { RenderedFilm{desc}; }),
        "test.yaml: render.integrator: planes knows no glass; use volume, or remove the glass");
    desc = scene_with_balls();
    desc.geometry[1].center = {0, 0, 0.1};
    EXPECT_EQ(message_of<InputError>([&] { RenderedFilm{desc}; }),
              "test.yaml: the camera is inside solid glass of the scene; describe the glass in "
              "front of a camera by camera.port");
}

}  // namespace
}  // namespace uw::test
