// ctest labels: analytic
// Light that the water's motion sets off, in flows whose speed and shear have closed forms: one
// velocity all over, simple shear, pure strain, and those that do not shear: turning and spreading.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/scene/scene_desc.h"
#include "media/volumes/load_volumes.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_fixtures.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using test::TempDir;
using test::VdbFixture;
using test::VelocityKind;
using Quantity = EmissionDesc::Stimulus::Quantity;

constexpr double k_edge = 0.05;  // m
constexpr int k_last = 15;       // voxels from -15 to 15

VdbFixture cells(const std::string& name, const std::function<double(int, int, int)>& value) {
    VdbFixture fixture;
    fixture.name = name;
    fixture.min = {-k_last, -k_last, -k_last};
    fixture.max = {k_last, k_last, k_last};
    fixture.value = value;
    fixture.file_from_index = Affine::scale(Vector3(k_edge));
    return fixture;
}

VolumeDesc stimulated(const std::filesystem::path& file, const EmissionDesc::Stimulus& stimulus) {
    VolumeDesc desc;
    desc.file = file;
    desc.where = "test";
    desc.emission.resize(1);
    desc.emission[0].grid = "cells";
    desc.emission[0].where = "test";
    desc.emission[0].stimulus = stimulus;
    desc.motion = MotionDesc{{"v.x", "v.y", "v.z"}, file, false, {}, 0, "test.velocity"};
    return desc;
}

class StimulatedLight : public testing::Test {
  protected:
    /// Light of value 2 in a flow: the velocity [m/s] at a place [m].
    VolumeDesc in_flow(const EmissionDesc::Stimulus& stimulus,
                       const std::function<Vector3(const Vector3&)>& flow) const {
        const auto component = [&](int axis) {
            return [=](int i, int j, int k) { return flow(k_edge * Vector3(i, j, k))[axis]; };
        };
        test::write_fixture(dir_ / "a.vdb", {cells("cells", [](int, int, int) { return 2.0; }),
                                             cells("v.x", component(0)), cells("v.y", component(1)),
                                             cells("v.z", component(2))});
        return stimulated(dir_ / "a.vdb", stimulus);
    }

    TempDir dir_;
};

// Speeds of 3 m/s, halfway from 1 to 5.
TEST_F(StimulatedLight, FollowsTheSpeed) {
    for (const auto kind :
         {VelocityKind::vectors, VelocityKind::staggered, VelocityKind::three_numbers}) {
        test::write_moving_grid(dir_ / "a.vdb", cells("cells", [](int, int, int) { return 2.0; }),
                                {1, 2, -2}, kind);
        VolumeDesc desc = stimulated(dir_ / "a.vdb", {Quantity::speed, 1, 5});
        if (kind == VelocityKind::three_numbers)
            desc.motion->grids = {"vel.x", "vel.y", "vel.z"};
        else
            desc.motion->grids = {"vel"};
        const LoadedVolume half = load_light(desc);
        // Rounding to 32 bits, and within a block to 16.
        EXPECT_NEAR(half.grids[0].value({0.1, 0.2, -0.3}), 1, 1e-5);
        EXPECT_NEAR(half.reports[0].statistics.min, 1, 1e-6);
        EXPECT_NEAR(half.reports[0].statistics.max, 1, 1e-6);
        // In a volume scaled by half it is 1.5 m/s, and in one scaled by 4 all the light is set
        // off.
        desc.world_from_upright = Affine::scale(Vector3(0.5));
        EXPECT_NEAR(load_light(desc).grids[0].value({0.1, 0.2, -0.3}), 0.25, 1e-5);
        desc.world_from_upright = Affine::scale(Vector3(4));
        EXPECT_NEAR(load_light(desc).grids[0].value({0.1, 0.2, -0.3}), 2, 1e-5);
        desc.world_from_upright = Affine();
        desc.motion->scale = 1.0 / 3;
        EXPECT_TRUE(load_light(desc).grids[0].bricks().empty());  // no light at the threshold
    }
}

// v = (g z, 0, 0): its speed is a ramp, whose integral along z has a closed form.
TEST_F(StimulatedLight, FollowsTheSpeedOfASimpleShear) {
    const double g = 4;
    const LoadedVolume light = load_light(in_flow(
        {Quantity::speed, 0.2, 1}, [=](const Vector3& x) { return Vector3(g * x.z, 0, 0); }));
    for (const double z : {0.0, 0.05, 0.1, 0.2, 0.4, 0.7})
        EXPECT_NEAR(light.grids[0].value({0.1, 0, z}),
                    2 * std::clamp((g * z - 0.2) / 0.8, 0.0, 1.0), 1e-4)
            << z;
    // Of |z|: a ramp over 0.8 / g, then 2 up to the last voxel's centre, from where the light
    // fades over a voxel. The ramp's corners lie at voxels.
    const double plain = k_edge * k_last - 1 / g;
    EXPECT_NEAR(light.grids[0].column({0, 0, -2}, {0, 0, 2}), 2 * (0.8 / g + 2 * plain + k_edge),
                1e-4);
}

TEST_F(StimulatedLight, FollowsTheRateOfShear) {
    const auto shear = [](const Vector3& x) { return Vector3(1 + 7 * x.z, 0, 0); };
    const auto strain = [](const Vector3& x) { return Vector3(3.5 * x.x, 1 - 3.5 * x.y, 2); };
    // Both 7 1/s: of what is set off from 4 to 10 1/s half, up to the faces of the grid.
    for (const auto& flow : std::array<std::function<Vector3(const Vector3&)>, 2>{shear, strain}) {
        VolumeDesc desc = in_flow({Quantity::shear, 4, 10}, flow);
        const LoadedVolume light = load_light(desc);
        // Differences of velocities of up to 6 m/s in 32 bits, over 5 cm.
        EXPECT_NEAR(light.reports[0].statistics.min, 1, 1e-5);
        EXPECT_NEAR(light.reports[0].statistics.max, 1, 1e-5);
        // It is a rate: neither the size of the world nor its axes matter.
        desc.world_from_upright =
            Affine::rotation_xyz_degrees({20, 40, -70}) * Affine::scale(Vector3(5));
        EXPECT_NEAR(load_light(desc).reports[0].statistics.mean, 1, 1e-5);
        // Stretched along x, the shear is 10.5 1/s, over 10, and the strain is the same.
        desc.world_from_upright = Affine::scale({1.5, 1, 1});
        EXPECT_NEAR(load_light(desc).reports[0].statistics.mean, flow(Vector3(0)).y == 0 ? 2 : 1,
                    1e-5);
    }
}

TEST_F(StimulatedLight, IsNoneWhereWaterTurnsOrSpreads) {
    const auto turning = [](const Vector3& x) {
        return glm::cross(Vector3(3, -2, 8), x) + Vector3(9, 9, 9);
    };
    const auto spreading = [](const Vector3& x) { return 20.0 * x + Vector3(20, 20, 20); };
    for (const auto& flow :
         std::array<std::function<Vector3(const Vector3&)>, 2>{turning, spreading})
        EXPECT_TRUE(
            load_light(in_flow({Quantity::shear, 1e-3, 1}, flow)).grids[0].bricks().empty());
}

// The light is that of the water which moves on: set off first, then blurred along its way.
TEST_F(StimulatedLight, IsBlurredWhileTheShutterIsOpen) {
    test::write_moving_grid(dir_ / "a.vdb", cells("cells", [](int, int, int) { return 2.0; }),
                            {3, 0, 0}, VelocityKind::vectors);
    VolumeDesc desc = stimulated(dir_ / "a.vdb", {Quantity::speed, 1, 5});
    desc.motion->grids = {"vel"};
    const double column = load_light(desc).grids[0].column({-2, 0, 0}, {2, 0, 0});
    desc.motion->shutter = 0.1;
    const GridVolume blurred = load_light(desc).grids[0];
    // Its edge, at 15.5 voxels in the mean, reaches 3 voxels to either side.
    EXPECT_NEAR(blurred.value({15.5 * k_edge, 0, 0}), 0.5, 5e-3);
    EXPECT_NEAR(blurred.column({-2, 0, 0}, {2, 0, 0}), column, 1e-3 * column);
}

TEST_F(StimulatedLight, IsReadWithItsVelocity) {
    in_flow({Quantity::speed, 0, 1}, [](const Vector3&) { return Vector3(1); });
    const auto read = [&](const std::string& emission, const std::string& velocity) {
        return read_scene_text(
            "uwvdb: 1\ncamera: {resolution: [4, 3], intrinsics: {fov_x: 50}}\n"
            "volumes: [{file: a.vdb, emission: {cells: " +
                emission + "}" + velocity + "}]\n",
            dir_ / "scene.yaml", {});
    };
    const std::string velocity = ", velocity: {grid: [v.x, v.y, v.z]}";
    const SceneDesc scene = read("{per_unit: [1, 2, 3], by_shear: [0, 20]}", velocity);
    EXPECT_EQ(scene.volumes[0].emission[0].stimulus,
              (EmissionDesc::Stimulus{Quantity::shear, 0, 20}));
    EXPECT_EQ(scene.volumes[0].motion->grids.size(), 3U);
    for (const std::string& warning : scene.warnings)
        EXPECT_EQ(warning.find("shutter"), std::string::npos) << warning;
    const SceneDesc table = read("{table: [[0, [0, 0, 1]], [2, [5, 0, 0]]]}", "");
    EXPECT_EQ(table.volumes[0].emission[0].table[1].light, (PerBand{5, 0, 0}));
    const auto error = [&](const std::string& emission, const std::string& with) {
        return test::message_of<InputError>([&] { (void)read(emission, with); });
    };
    test::expect_contains(error("{per_unit: 1, by_speed: [1, 2]}", ""),
                          "give the volume its velocity");
    test::expect_contains(error("{per_unit: 1, by_speed: [2, 1]}", velocity),
                          "less than the second");
    test::expect_contains(error("{per_unit: 1, by_speed: [1, 2], by_shear: [1, 2]}", velocity),
                          "by speed or by shear");
    test::expect_contains(error("{blackbody: 1, by_speed: [1, 2]}", velocity), "per_unit only");
    test::expect_contains(error("{table: [[1, 1], [1, 2]]}", velocity), "must ascend");
}

}  // namespace
}  // namespace uw
