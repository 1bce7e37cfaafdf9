// ctest labels: unit analytic threads
#include "edit/session/view_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace {

using namespace uw;

// 200 x 100 pixels, 100 pixels of focal length, at (1, 2, 3), without a port: a pinhole.
CameraDesc pinhole() {
    CameraDesc camera;
    camera.width = 200;
    camera.height = 100;
    camera.intrinsics = {100, 100, 100, 50};
    camera.world_from_camera = Affine::translation({1, 2, 3});
    return camera;
}

CameraDesc behind_glass() {
    CameraDesc camera = pinhole();
    camera.port = FlatPortDesc{.distance = 0.05, .thickness = 0.02};
    return camera;
}

LampDesc lamp_at(const Point3& position, const Vector3& direction) {
    LampDesc lamp;
    lamp.position = position;
    lamp.direction = direction;
    return lamp;
}

double norm(const Point3& a, const Point3& b) {
    return distance(a, b);
}

TEST(ViewGeometry, PointsAreSeenWhereAPinholeShowsThem) {
    const Camera camera(pinhole());
    // 2 m ahead, 1 m to the right and 0.5 m down: 100 * 1 / 2 and 100 * 0.5 / 2 from the centre.
    const ViewHandle inside = view_handle(camera, {2, 2.5, 5});
    ASSERT_TRUE(inside.pixel);
    EXPECT_TRUE(inside.inside);
    EXPECT_NEAR(inside.pixel->x, 150, 1e-6);
    EXPECT_NEAR(inside.pixel->y, 75, 1e-6);
    EXPECT_NEAR(inside.rim.x, 150, 1e-6);

    // 3 m right, 0.6 m down at 1 m: (400, 110); from the centre 300 right, 60 down: the rim is
    // reached at the right side, 100 right, 20 down.
    const ViewHandle outside = view_handle(camera, {4, 2.6, 4});
    ASSERT_TRUE(outside.pixel);
    EXPECT_FALSE(outside.inside);
    EXPECT_NEAR(outside.pixel->x, 400, 1e-6);
    EXPECT_NEAR(outside.rim.x, 200, 1e-6);
    EXPECT_NEAR(outside.rim.y, 70, 1e-6);

    // Behind the camera, above it: at the top, where one would have to look up.
    const ViewHandle behind = view_handle(camera, {1, 1, 2});
    EXPECT_FALSE(behind.pixel);
    EXPECT_NEAR(behind.rim.x, 100, 1e-6);
    EXPECT_NEAR(behind.rim.y, 0, 1e-6);
}

TEST(ViewGeometry, DraggedPointsAreSeenWhereTheyWereDragged) {
    for (const CameraDesc& desc : {pinhole(), behind_glass()}) {
        const Camera camera(desc);
        const Point3 from{1.4, 2.1, 4.5}, centre{1, 2, 3};
        for (const ImagePoint& pixel : {ImagePoint{20, 80}, {100, 50}, {190, 10}}) {
            const Point3 same_distance = dragged_point(camera, pixel, from, DragKeeps::distance);
            const Point3 same_depth = dragged_point(camera, pixel, from, DragKeeps::depth);
            EXPECT_NEAR(norm(same_distance, centre), norm(from, centre), 1e-9);
            EXPECT_NEAR(same_depth.z, from.z, 1e-9);
            for (const Point3& point : {same_distance, same_depth}) {
                const auto seen = camera.project(point);
                ASSERT_TRUE(seen);
                // Camera::project is exact to 1e-6 pixel.
                EXPECT_NEAR(seen->x, pixel.x, 2e-6);
                EXPECT_NEAR(seen->y, pixel.y, 2e-6);
            }
        }
        const auto pixel = camera.project(from);
        const Point3 farther = point_at_distance(camera, from, 2.5);
        EXPECT_NEAR(norm(farther, centre), 2.5, 1e-9);
        EXPECT_NEAR(camera.project(farther)->x, pixel->x, 2e-6);
    }
    // 3 cm from the camera's centre is inside the glass of 5 to 7 cm.
    EXPECT_THROW(
        dragged_point(Camera(behind_glass()), {100, 50}, {1, 2, 3.03}, DragKeeps::distance),
        UsageError);
}

TEST(ViewGeometry, AimedLampsHaveTheirAxisWhereItWasDragged) {
    const Camera camera(behind_glass());
    const PlacedLamp lamp = placed_lamp(lamp_at({0.4, 0.1, 1.5}, {0, 0, 1}), behind_glass());
    for (const ImagePoint& pixel : {ImagePoint{120, 40}, {140, 60}, {100, 55}}) {
        const Vector3 direction = aimed_direction(camera, pixel, lamp);
        EXPECT_NEAR(glm::length(direction), 1, 1e-12);
        const auto seen = camera.project(axis_point({lamp.position, direction}));
        ASSERT_TRUE(seen);
        EXPECT_NEAR(seen->x, pixel.x, 2e-6);
        EXPECT_NEAR(seen->y, pixel.y, 2e-6);
        // It is the one of the two directions that needs the lesser turn.
        EXPECT_GT(direction.z, 0);
    }
}

TEST(ViewGeometry, AConeAheadIsSeenAsACircleOfItsAngle) {
    const Camera camera(pinhole());
    LampDesc desc = lamp_at({0, 0, 1}, {0, 0, 1});
    desc.profile = SpotProfileDesc{.beam = 40, .edge = 0};
    const auto outline = beam_outline(camera, desc, placed_lamp(desc, pinhole()));
    ASSERT_GT(outline.size(), 32U);
    // The rim of the cone is at depth 1 + cos 20 degrees, sin 20 degrees from the axis.
    const double angle = 20 * std::numbers::pi / 180;
    const double radius = 100 * std::sin(angle) / (1 + std::cos(angle));
    for (const ImagePoint& point : outline)
        EXPECT_NEAR(std::hypot(point.x - 100, point.y - 50), radius, 1e-5);
    desc.profile = IsotropicProfileDesc{};
    EXPECT_TRUE(beam_outline(camera, desc, placed_lamp(desc, pinhole())).empty());
}

TEST(ViewGeometry, TheFrustumIsRefracted) {
    const auto dry = view_frustum(Camera(pinhole()));
    const auto wet = view_frustum(Camera(behind_glass()));
    ASSERT_EQ(dry.size(), 4U);
    ASSERT_EQ(wet.size(), 4U);
    // At the corner of the image, in air tan = 1 across and 0.5 along: sin^2 = 1.25 / 2.25. Snell's
    // law through parallel glass: sin in water is that over 1.334.
    const double sine = std::sqrt(1.25 / 2.25) / 1.334;
    const Camera camera(behind_glass());
    const auto ray = camera.refracted_ray(0, 0);
    EXPECT_NEAR(ray->direction.z, std::sqrt(1 - sine * sine), 1e-9);
    EXPECT_NEAR(norm(wet[0], ray->origin), 1, 1e-12);
    EXPECT_LT(wet[0].x, wet[1].x);
    EXPECT_LT(wet[0].y, wet[3].y);
}

}  // namespace
