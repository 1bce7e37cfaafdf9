// ctest labels: unit
#include "core/scene/scene_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

/// A scene with one of everything, all of it well within the limits.
SceneDesc whole_scene() {
    SceneDesc scene = pinhole_scene(16, 9);
    scene.camera.where = "s.yaml:2: camera";
    DomePortDesc dome;
    dome.radius = 0.1;
    scene.camera.port = dome;
    scene.camera.lens = LensDesc{.f_number = 2.8, .focal_length = 0.01};
    scene.lamps = {isotropic_lamp({0, 0, 0}, 5)};
    scene.lamps[0].where = "s.yaml:5: lamps[0]";
    scene.lamps[0].profile = SpotProfileDesc{.beam = 40, .edge = 5};
    scene.geometry = {plane_at_z(3)};
    scene.geometry[0].where = "s.yaml:7: geometry[0]";
    VolumeDesc volume;
    volume.where = "s.yaml:9: volumes[0]";
    volume.grids.emplace_back();
    volume.grids[0].where = "s.yaml:9: grids.density";
    volume.grids[0].large_ppm = 2;
    scene.volumes = {volume};
    return scene;
}

TEST(SceneLimits, LetScenesPass) {
    EXPECT_NO_THROW(check_limits(whole_scene()));
}

TEST(SceneLimits, LetPassWhatIsLargeOrNarrow) {
    SceneDesc scene = whole_scene();
    scene.camera.world_from_camera = Affine::translation({9e6, -9e6, 0});
    scene.camera.intrinsics.fx = scene.camera.intrinsics.fy = 1e6;
    scene.lamps[0].profile = CosineProfileDesc{0.02};
    scene.lamps[0].intensity = PerBand(3, 1e9);
    EXPECT_NO_THROW(check_limits(scene));
}

struct BadScene {
    const char* name;
    std::function<void(SceneDesc&)> spoil;
    const char* message;  // how it begins
};

void PrintTo(const BadScene& bad, std::ostream* out) {
    *out << bad.name;
}

class SceneBeyondLimits : public testing::TestWithParam<BadScene> {};

TEST_P(SceneBeyondLimits, IsRefusedInOneLine) {
    SceneDesc scene = whole_scene();
    GetParam().spoil(scene);
    const std::string message = message_of<InputError>([&] { check_limits(scene); });
    EXPECT_EQ(message.substr(0, std::string(GetParam().message).size()), GetParam().message)
        << message;
}

INSTANTIATE_TEST_SUITE_P(
    All, SceneBeyondLimits,
    testing::Values(
        BadScene{"camera_far_away",
                 [](SceneDesc& s) {
                     s.camera.world_from_camera = Affine::translation({1e20, 0, 0});
                 },
                 "s.yaml:2: camera: its position of 1e+20 is beyond 1e+07"},
        BadScene{"camera_nowhere",
                 [](SceneDesc& s) {
                     s.camera.world_from_camera = Affine::translation({0, k_nan, 0});
                 },
                 "s.yaml:2: camera: its position is not a finite number"},
        BadScene{"camera_not_turned",
                 [](SceneDesc& s) {
                     s.camera.world_from_camera = {Matrix3(k_nan), {}};
                 },
                 "s.yaml:2: camera: its pose is not a finite number"},
        BadScene{"tiny_focal_length", [](SceneDesc& s) { s.camera.intrinsics.fx = 1e-300; },
                 "s.yaml:2: camera: fx = 1e-300 and cx = 8 pixels show more than 89.99 degrees"},
        BadScene{"focal_length_not_a_number", [](SceneDesc& s) { s.camera.intrinsics.fy = k_nan; },
                 "s.yaml:2: camera: fy = nan"},
        BadScene{"huge_focal_length", [](SceneDesc& s) { s.camera.intrinsics.fy = 1e12; },
                 "s.yaml:2: camera: fy = 1e+12 pixels is beyond 1e+09"},
        BadScene{"centre_far_out", [](SceneDesc& s) { s.camera.intrinsics.cy = -1e9; },
                 "s.yaml:2: camera: fy = "},
        BadScene{"focus_far_away", [](SceneDesc& s) { s.camera.lens->focus_distance = 1e9; },
                 "s.yaml:2: camera: its lens's focus distance of 1e+09 is beyond 1e+07"},
        BadScene{"fisheye_with_focus",
                 [](SceneDesc& s) {
                     s.camera.lens->focus_distance = 2;
                     s.camera.distortion.model = DistortionDesc::Model::fisheye;
                 },
                 "s.yaml:2: camera: lens.focus_distance: depth of field is that of a rectilinear"},
        BadScene{"distortion", [](SceneDesc& s) { s.camera.distortion.k[2] = k_nan; },
                 "s.yaml:2: camera: a coefficient of its distortion is not a finite number"},
        BadScene{"port", [](SceneDesc& s) { std::get<DomePortDesc>(*s.camera.port).radius = 1e9; },
                 "s.yaml:2: camera: its port's radius of 1e+09"},
        BadScene{"lens",
                 [](SceneDesc& s) {
                     s.camera.lens->focal_length = std::numeric_limits<double>::infinity();
                 },
                 "s.yaml:2: camera: its lens's focal length is not a finite number"},
        BadScene{"lamp_far_away",
                 [](SceneDesc& s) {
                     s.lamps[0].position = {0, 0, -1e39};
                 },
                 "s.yaml:5: lamps[0]: its position of -1e+39"},
        BadScene{"lamp_mount",
                 [](SceneDesc& s) {
                     s.lamps[0].world_from_mount = Affine::translation({0, 1e8, 0});
                 },
                 "s.yaml:5: lamps[0]: its frame of 1e+08"},
        BadScene{"lamp_direction", [](SceneDesc& s) { s.lamps[0].direction.x = k_nan; },
                 "s.yaml:5: lamps[0]: its direction is not a finite number"},
        BadScene{"narrow_cosine",
                 [](SceneDesc& s) { s.lamps[0].profile = CosineProfileDesc{1e-9}; },
                 "s.yaml:5: lamps[0]: its beam of 1e-09 degrees is narrower than 0.01"},
        BadScene{"narrow_spot",
                 [](SceneDesc& s) { s.lamps[0].profile = SpotProfileDesc{.beam = 1e-5}; },
                 "s.yaml:5: lamps[0]: its beam of 1e-05 degrees"},
        BadScene{"extent",
                 [](SceneDesc& s) {
                     s.lamps[0].extent.emplace();
                     s.lamps[0].extent->radius = 1e8;
                 },
                 "s.yaml:5: lamps[0]: its radius of 1e+08 is beyond 1e+07"},
        BadScene{"sun_from_below",
                 [](SceneDesc& s) {
                     s.lamps[0].direction = {0, -1, 0};
                     s.lamps[0].sun = SunDesc{.surface = {{0, -3, 0}, {0, -1, 0}}};
                 },
                 "s.yaml:5: lamps[0]: its light comes from 180 degrees off the normal of "
                 "water.surface, beyond 89"},
        BadScene{"sun_half_below_the_horizon",
                 [](SceneDesc& s) {
                     s.lamps[0].direction = {std::sqrt(0.5), std::sqrt(0.5), 0};
                     s.lamps[0].sun = SunDesc{.angle = 90, .surface = {{0, -3, 0}, {0, -1, 0}}};
                 },
                 "s.yaml:5: lamps[0]: its light comes from 90 degrees off"},
        BadScene{"water_surface_far_away",
                 [](SceneDesc& s) {
                     s.water.where = "s.yaml:3: water";
                     s.water.surface = WaterSurfaceDesc{{0, 1e9, 0}, {0, 1, 0}};
                 },
                 "s.yaml:3: water: its surface's point of 1e+09"},
        BadScene{"snow_without_particles",
                 [](SceneDesc& s) {
                     s.water.where = "s.yaml:3: water";
                     s.water.snow.emplace().number = 5e-324;
                 },
                 "s.yaml:3: water: its snow's number of 4.94066e-324 is below 1e-12"},
        BadScene{"sensor_without_a_well",
                 [](SceneDesc& s) { s.camera.sensor.emplace().full_well = 5e-324; },
                 "s.yaml:2: camera: its sensor's full_well of 4.94066e-324 is below 1e-12"},
        BadScene{"intensity",
                 [](SceneDesc& s) {
                     s.lamps[0].intensity = PerBand{1, 1e30, 1};
                 },
                 "s.yaml:5: lamps[0]: its intensity of 1e+30"},
        BadScene{"plane", [](SceneDesc& s) { s.geometry[0].point.z = 1e8; },
                 "s.yaml:7: geometry[0]: its point of 1e+08"},
        BadScene{"transform",
                 [](SceneDesc& s) {
                     s.geometry[0].world_from_object = Affine::scale({1, 1, k_nan});
                 },
                 "s.yaml:7: geometry[0]: its transform is not a finite number"},
        BadScene{
            "volume",
            [](SceneDesc& s) { s.volumes[0].world_from_upright = Affine::scale(Vector3(1e9)); },
            "s.yaml:9: volumes[0]: its transform of 1e+09"},
        BadScene{"concentration", [](SceneDesc& s) { s.volumes[0].grids[0].large_ppm = 1e13; },
                 "s.yaml:9: grids.density: its concentration of 1e+13"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace uw::test
