// ctest labels: unit analytic
#include "core/light/lamp_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "tests/support/ies_files.h"
#include "tests/support/lamp_profile_laws.h"

namespace uw {
namespace {

using std::numbers::pi;

std::shared_ptr<const PhotometricWeb> shared_web(const test::IesWriter& writer) {
    return std::make_shared<PhotometricWeb>(parse_ies(writer.text(), "lamp.ies"));
}

// A luminaire twice as bright towards azimuth 0 as towards 180, dark towards 90.
IesProfile asymmetric_profile(const IesProfileDesc& desc, const LampPlacement& placement = {}) {
    test::IesWriter writer;
    writer.polar = {0, 90, 180};
    writer.planes = {0, 90, 180, 270, 360};
    writer.candelas = [](double polar, double plane) {
        if (polar != 90) return polar == 0 ? 1.0 : 0.0;
        return plane == 180 ? 0.5 : (plane == 0 || plane == 360 ? 1.0 : (plane == 90 ? 0.25 : 0.0));
    };
    return {desc, placement, shared_web(writer)};
}

TEST(IesProfile, HangsInTheFrameOfTheLamp) {
    // Camera axes: x right, y down, z forward. Shining forward, azimuth 0 is right and 90 up.
    const IesProfile lamp = asymmetric_profile({});
    EXPECT_NEAR(lamp.relative_intensity({0, 0, 2}), 1, 1e-12);
    EXPECT_NEAR(lamp.relative_intensity({0, 0, -2}), 0, 1e-12);
    EXPECT_NEAR(lamp.relative_intensity({3, 0, 0}), 1, 1e-12);
    EXPECT_NEAR(lamp.relative_intensity({-3, 0, 0}), 0.5, 1e-12);
    EXPECT_NEAR(lamp.relative_intensity({0, -1, 0}), 0.25, 1e-12);
    EXPECT_NEAR(lamp.relative_intensity({0, 1, 0}), 0, 1e-12);
    EXPECT_NEAR(lamp.relative_intensity({1, -1, 0}), 0.625, 1e-12);
    EXPECT_FALSE(lamp.has_even_core());
}

TEST(IesProfile, TurnsAndTilts) {
    IesProfileDesc desc;
    desc.rotate = 90;  // what was right is up now
    const IesProfile turned = asymmetric_profile(desc);
    EXPECT_NEAR(turned.relative_intensity({0, -1, 0}), 1, 1e-12);
    EXPECT_NEAR(turned.relative_intensity({-1, 0, 0}), 0.25, 1e-12);
    desc.tilt = 90;  // and now the axis is up, with azimuth 0 backwards
    const IesProfile tilted = asymmetric_profile(desc);
    EXPECT_NEAR(tilted.relative_intensity({0, 1, 0}), 0, 1e-12);
    EXPECT_NEAR(tilted.relative_intensity({0, 0, 1}), 0.5, 1e-12);
    EXPECT_NEAR(tilted.relative_intensity({-1, 0, 0}), 0.25, 1e-12);
    // Along x, azimuth 0 is towards y.
    const IesProfile sideways = asymmetric_profile({}, {Affine(), {1, 0, 0}});
    EXPECT_NEAR(sideways.relative_intensity({0, -1, 0}), 0.5, 1e-12);
}

TEST(IesProfile, MovesWithTheCamera) {
    IesProfileDesc desc;
    desc.rotate = 30;
    const Vector3 direction = glm::normalize(Vector3(0.2, -0.3, 1));
    const Affine world_from_camera =
        Affine::translation({1, 2, 3}) * Affine::rotation_xyz_degrees({20, -70, 110});
    const IesProfile at_rest = asymmetric_profile(desc, {Affine(), direction}),
                     moved = asymmetric_profile(desc, {world_from_camera, direction});
    for (const Vector3& v : {Vector3(1, 0, 0), Vector3(-0.4, 2, 0.1), Vector3(0.3, 0.2, -0.9)})
        EXPECT_NEAR(moved.relative_intensity(world_from_camera.apply_to_vector(v)),
                    at_rest.relative_intensity(v), 1e-12);
}

TEST(IesProfile, ObeysTheLaws) {
    test::expect_lamp_profile_laws(asymmetric_profile({{}, 30, 50}));
}

TEST(IesProfile, SolidAngleIsTheIntegral) {
    test::IesWriter writer;
    writer.polar = {0, 90};
    writer.candelas = [](double, double) { return 123.0; };
    const IesProfile half_sphere({}, {}, shared_web(writer));
    EXPECT_NEAR(half_sphere.solid_angle(), 2 * pi, 1e-12);
    EXPECT_EQ(half_sphere.peak_candelas(), 123);
    const IesProfile profile = asymmetric_profile({{}, 30, 50});
    // Midpoints half a degree apart: kinks only, 1e-5 of the whole.
    EXPECT_NEAR(profile.solid_angle(), test::solid_angle_by_quadrature(profile, 720, 720), 1e-4);
}

}  // namespace
}  // namespace uw
