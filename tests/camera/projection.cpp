// ctest labels: unit analytic
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "camera/camera.h"
#include "tests/support/projection_cases.h"

namespace uw {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

CameraDesc wide() {
    CameraDesc desc;
    desc.width = 640;
    desc.height = 480;
    desc.intrinsics = {300, 300, 320, 240};
    return desc;
}

TEST(Projection, UndoesTheRaysOfEveryLensBehindEveryPort) {
    for (const auto& [name, desc] : test::projection_cameras()) {
        const test::ProjectionTally tally = test::tally_projections(desc, 20000);
        EXPECT_EQ(tally.failures, 0) << name;
        EXPECT_LT(tally.worst, 1e-6) << name;  // asked for by physics.md, section 3
    }
}

TEST(Projection, SightsAreProjectionsWithTheirRays) {
    for (const auto& [name, desc] : test::projection_cameras()) {
        const Camera camera(desc);
        int seen = 0;
        for (int i = 0; i < 25; ++i) {
            const double x = (i % 5 + 0.3) / 5 * desc.width, y = (i / 5 + 0.6) / 5 * desc.height;
            const auto ray = camera.refracted_ray(x, y);
            if (!ray) continue;
            const Point3 point = ray->at(1.5 + 0.2 * i);
            const auto image = camera.project(point);
            const auto sight = camera.sight(point);
            ASSERT_EQ(sight.has_value(), image.has_value()) << name;
            if (!sight) continue;
            ++seen;
            EXPECT_EQ(sight->image.x, image->x) << name;
            EXPECT_EQ(sight->image.y, image->y) << name;
            // 1e-6 pixels, the promise of project, are 1e-8 m on a port 5 cm away.
            EXPECT_LT(distance(sight->ray.origin, ray->origin), 1e-8) << name;
            EXPECT_LT(glm::length(sight->ray.direction - ray->direction), 1e-8) << name;
        }
        EXPECT_GT(seen, 10) << name;
    }
    EXPECT_FALSE(Camera(wide()).sight({0, 0, -1}));
}

TEST(Projection, PinholeByHand) {
    const Camera camera(wide());
    const auto seen = camera.project({1, -0.5, 2});
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->x, 320 + 150, 1e-12);
    EXPECT_NEAR(seen->y, 240 - 75, 1e-12);
    EXPECT_TRUE(camera.project({100, 0, 1}));  // outside of the image, but on a ray of the lens
    EXPECT_FALSE(camera.project({0, 0, -1}));
    EXPECT_FALSE(camera.project({1, 0, 0}));
    EXPECT_FALSE(camera.project({0, 0, 0}));
    CameraDesc all_around = wide();
    all_around.distortion.model = DistortionDesc::Model::fisheye;
    EXPECT_FALSE(Camera(all_around).project({0, 0, 0}));  // of no direction
}

TEST(Projection, FlatPortByPlaneTrigonometry) {
    CameraDesc desc = wide();
    desc.port = FlatPortDesc{{0, 0, 1}, 0.02, 0.04, 1.0, 1.49, 1.334};
    const Camera camera(desc);
    for (const double degrees : {1e-6, 5.0, 40.0, 70.0, 85.0, 89.9}) {
        const double air = degrees * std::numbers::pi / 180;
        const double glass = std::asin(std::sin(air) / 1.49);
        const double water = std::asin(std::sin(air) / 1.334);
        for (const double depth : {0.0, 0.1, 5.0, 100.0}) {
            const double across =
                0.02 * std::tan(air) + 0.04 * std::tan(glass) + depth * std::tan(water);
            const auto seen = camera.project({0, across, 0.06 + depth});
            ASSERT_TRUE(seen) << degrees << " " << depth;
            EXPECT_NEAR(seen->x, 320, 1e-9);
            // At 89.9 degrees the place is 300 tan(air) = 2e5 pixels out.
            const double truth = 300 * std::tan(air);
            EXPECT_NEAR(seen->y - 240, truth, 1e-10 * std::max(1.0, truth)) << degrees;
        }
    }
}

TEST(Projection, NothingIsSeenInTheHousingOrItsGlass) {
    CameraDesc desc = wide();
    desc.port = FlatPortDesc{{0, 0, 1}, 0.02, 0.04, 1.0, 1.49, 1.334};
    EXPECT_FALSE(Camera(desc).project({0, 0, 0.059}));
    EXPECT_FALSE(Camera(desc).project({0, 0, -1}));
    EXPECT_TRUE(Camera(desc).project({0, 0, 0.061}));
    desc.port = DomePortDesc{{0, 0, 0}, 0.05, 0.01, 1.0, 1.49, 1.334};
    EXPECT_FALSE(Camera(desc).project({0, 0, 0.059}));
    EXPECT_TRUE(Camera(desc).project({0, 0, 0.061}));
    EXPECT_FALSE(Camera(desc).project({0, 0, -1}));  // a ray of the dome, none of the lens
}

TEST(Projection, WhereAWaterRayBeginsIsSeen) {
    for (const auto& [name, desc] : test::projection_cameras()) {
        if (!desc.port) continue;
        const Camera camera(desc);
        for (const double x : {600.5, 1000.5, 1300.5}) {
            const auto ray = camera.refracted_ray(x, 400.5);
            ASSERT_TRUE(ray) << name;
            const auto seen = camera.project(ray->origin);
            ASSERT_TRUE(seen) << name << " " << x;
            EXPECT_NEAR(seen->x, x, 1e-8) << name;  // 5 m / 0.06 m of a double's 1e-16 in pixels
        }
    }
}

TEST(Projection, FlatPortOnTheLensHasAnEdge) {
    // With the camera's centre on the glass, rays at 90 degrees still meet finite places.
    CameraDesc desc = wide();
    desc.distortion.model = DistortionDesc::Model::fisheye;
    desc.port = FlatPortDesc{{0, 0, 1}, 0, 0.04, 1.0, 1.49, 1.334};
    const double edge = 0.04 * std::tan(std::asin(1 / 1.49)) + std::tan(std::asin(1 / 1.334));
    const Camera camera(desc);
    const auto inside = camera.project({0.999 * edge, 0, 1.04});
    ASSERT_TRUE(inside);
    EXPECT_LT(inside->x, 320 + 300 * std::numbers::pi / 2);
    EXPECT_FALSE(camera.project({1.001 * edge, 0, 1.04}));
}

TEST(Projection, ThroughIndicesOfAnyOrder) {
    // Air denser than water: a camera in water that looks into an air-filled tank.
    for (const double n_glass : {1.1, 1.49}) {
        CameraDesc desc = wide();
        desc.port = FlatPortDesc{{0.1, 0, std::sqrt(0.99)}, 0.05, 0.02, 1.334, n_glass, 1.0};
        EXPECT_EQ(test::tally_projections(desc, 2000).failures, 0);
        EXPECT_LT(test::tally_projections(desc, 2000).worst, 1e-6);
        desc.port = DomePortDesc{{0.005, 0, -0.01}, 0.05, 0.01, 1.334, n_glass, 1.0};
        EXPECT_EQ(test::tally_projections(desc, 2000).failures, 0);
        EXPECT_LT(test::tally_projections(desc, 2000).worst, 1e-6);
    }
}

TEST(Projection, CameraCloseToItsDome) {
    CameraDesc desc = wide();
    desc.distortion.model = DistortionDesc::Model::fisheye;
    desc.port = DomePortDesc{{0.03, 0, -0.0399}, 0.05, 0.002, 1.0, 1.49, 1.334};
    const test::ProjectionTally tally = test::tally_projections(desc, 5000);
    EXPECT_EQ(tally.failures, 0);
    EXPECT_LT(tally.worst, 1e-6);
}

TEST(Projection, HostilePointsGiveNothing) {
    for (const auto& [name, desc] : test::projection_cameras()) {
        const Camera camera(desc);
        for (const double bad : {k_infinity, -k_infinity, std::nan("")})
            EXPECT_FALSE(camera.project({bad, 1, bad})) << name;
    }
    // Which no rotation makes NaN on their way to the lens.
    CameraDesc fisheye = wide();
    fisheye.distortion.model = DistortionDesc::Model::fisheye;
    for (const CameraDesc& desc : {wide(), fisheye})
        for (const Point3& point : {Point3(k_infinity, 0, 1), Point3(0, 0, k_infinity),
                                    Point3(-k_infinity, 1, 1), Point3(1, k_infinity, k_infinity)})
            EXPECT_FALSE(Camera(desc).project(point));
}

}  // namespace
}  // namespace uw
