// ctest labels: unit analytic
#include "camera/camera.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace uw {
namespace {

constexpr double k_focal_length = 0.05, k_f_number = 1.4,
                 k_radius = k_focal_length / 2 / k_f_number;
constexpr double k_rounding = 1e-12;

CameraDesc focused_at(double distance) {
    CameraDesc desc;
    desc.width = 640;
    desc.height = 480;
    desc.intrinsics = {500, 510, 320, 240};
    desc.lens = LensDesc{k_f_number, k_focal_length, 1, distance};
    return desc;
}

std::vector<AperturePoint> rim() {
    std::vector<AperturePoint> points;
    for (int i = 0; i < 12; ++i)
        points.push_back({std::cos(std::numbers::pi * i / 6), std::sin(std::numbers::pi * i / 6)});
    return points;
}

Point3 at_z(const Ray& ray, double z) {
    return ray.at((z - ray.origin.z) / ray.direction.z);
}

TEST(ThinLens, RaysOfAPixelMeetInThePlaneOfFocusAndSpreadLinearlyElsewhere) {
    const Camera camera(focused_at(1.5));
    ASSERT_TRUE(camera.has_aperture());
    EXPECT_NEAR(camera.focus_vergence(), 1 / 1.5, k_rounding);
    for (const auto& [x, y] : {std::array{320.0, 240.0}, {11.0, 400.0}, {630.0, 2.0}})
        for (const AperturePoint& point : rim()) {
            const Ray chief = camera.refracted_ray(x, y).value();
            const Ray ray = camera.aperture_ray(x, y, point).value();
            EXPECT_NEAR(glm::length(ray.direction), 1, k_rounding);
            EXPECT_NEAR(distance(at_z(ray, 1.5), at_z(chief, 1.5)), 0, k_rounding);
            EXPECT_NEAR(distance(at_z(ray, 0), at_z(chief, 0)), k_radius, k_rounding);
            EXPECT_NEAR(distance(at_z(ray, 3), at_z(chief, 3)), k_radius, k_rounding);
            EXPECT_NEAR(distance(at_z(ray, 2), at_z(chief, 2)), k_radius / 3, k_rounding);
        }
}

TEST(ThinLens, TheRayThroughTheMiddleIsThatOfThePinhole) {
    CameraDesc desc = focused_at(2);
    desc.port = FlatPortDesc{};
    std::get<FlatPortDesc>(*desc.port).distance = 0.02;
    std::get<FlatPortDesc>(*desc.port).thickness = 0.04;
    const Camera camera(desc);
    for (const auto& [x, y] : {std::array{320.0, 240.0}, {11.0, 400.0}}) {
        const Ray chief = camera.refracted_ray(x, y).value();
        const Ray ray = camera.aperture_ray(x, y, {}).value();
        EXPECT_NEAR(distance(ray.origin, chief.origin), 0, k_rounding);
        EXPECT_NEAR(glm::length(ray.direction - chief.direction), 0, k_rounding);
    }
    desc.lens->focus_distance.reset();
    const Camera sharp(desc);
    EXPECT_FALSE(sharp.has_aperture());
    EXPECT_EQ(sharp.aperture_ray(11, 400, {1, 0})->direction,
              sharp.refracted_ray(11, 400)->direction);
}

/// Near the axis a flat port brings things nearer: every layer counts by its depth over its index.
TEST(ThinLens, BehindAFlatPortTheFocusIsInTheWater) {
    for (const double focus : {0.3, 1.0, 5.0}) {
        CameraDesc desc = focused_at(focus);
        FlatPortDesc port;
        port.distance = 0.02;
        port.thickness = 0.04;
        desc.port = port;
        const Camera camera(desc);
        const double apparent = 0.02 + 0.04 / 1.49 + (focus - 0.06) / 1.334;
        // These are the rays 10 um beside the axis, whose aberration is 1e-9 of the distance.
        EXPECT_NEAR(camera.focus_vergence() * apparent, 1, 1e-8);
        // Rays of the whole aperture, which the port's aberration keeps apart: their cubes of the
        // angle, a/z, times the path.
        const double angle = k_radius / focus;
        for (const AperturePoint& point : rim()) {
            const Point3 at_focus = at_z(*camera.aperture_ray(320, 240, point), focus);
            EXPECT_LT(std::hypot(at_focus.x, at_focus.y), std::pow(angle, 3) * focus);
        }
        const Point3 behind = at_z(*camera.aperture_ray(320, 240, {1, 0}), 2 * focus);
        EXPECT_GT(std::abs(behind.x), 0.5 * k_radius);
    }
}

/// In a dome around the camera's centre the lens looks at a nearer, smaller picture of the water;
/// a decentred one tilts nothing on the axis but has a focus of its own.
TEST(ThinLens, InADomeRaysNearTheAxisMeetAtTheFocus) {
    for (const double decentred : {0.0, 0.03}) {
        CameraDesc desc = focused_at(1.2);
        desc.lens->f_number = 50;  // near the axis
        DomePortDesc port;
        port.center = {0, 0, decentred};
        port.radius = 0.1;
        port.thickness = 0.01;
        desc.port = port;
        const Camera camera(desc);
        EXPECT_GT(camera.focus_vergence(), 1.5 / 1.2);
        const double radius = k_focal_length / 100;
        for (const AperturePoint& point : rim()) {
            const Point3 at_focus = at_z(*camera.aperture_ray(320, 240, point), 1.2);
            EXPECT_LT(std::hypot(at_focus.x, at_focus.y), 1e-3 * radius);
        }
    }
    // Infinity, seen through a dome of one thin surface around the camera's centre: its power is
    // (n_a - n_w) / r, so that the picture stands n_a r / (n_w - n_a) before its vertex.
    CameraDesc desc = focused_at(1e7);
    DomePortDesc port;
    port.radius = 0.1;
    port.n_glass = 1.334;
    desc.port = port;
    const double vertex_to_picture = 0.1 / (1.334 - 1.0);
    EXPECT_NEAR(Camera(desc).focus_vergence(), 1 / (0.1 + vertex_to_picture), 1e-6);
}

TEST(ThinLens, WhatCannotBeInFocusIsRefused) {
    const auto refuses = [](const CameraDesc& desc, const std::string& part) {
        try {
            const Camera camera(desc);
            ADD_FAILURE() << part;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    };
    CameraDesc desc = focused_at(0.05);
    FlatPortDesc port;
    port.distance = 0.1;
    desc.port = port;
    refuses(desc, "lies before the water");
    refuses(focused_at(0.04), "within the focal length");
    desc = focused_at(1);
    DomePortDesc dome;
    dome.radius = 0.015;
    desc.port = dome;
    refuses(desc, "35.7 mm wide, does not fit into the dome");
}

}  // namespace
}  // namespace uw
