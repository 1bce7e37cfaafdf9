// ctest labels: unit analytic
#include "cli/info/plume_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "camera/camera.h"
#include "render/scene_loading.h"

namespace uw {
namespace {

Camera camera_of(const SceneProposal& proposal) {
    return Camera(load_scene_text(proposal_yaml(proposal), "proposal.yaml").camera);
}

bool is_in_picture(const Camera& camera, const Point3& x) {
    const auto pixel = camera.project(x);
    return pixel && pixel->x >= 0 && pixel->y >= 0 && pixel->x <= camera.width() &&
           pixel->y <= camera.height();
}

Bounds box(const Point3& min, const Point3& max) {
    Bounds bounds;
    bounds.extend(min);
    bounds.extend(max);
    return bounds;
}

TEST(SceneProposal, TheCameraSeesAllOfTheBoxAndNoLamp) {
    for (const Bounds& bounds :
         {box({0, 0, 0}, {1, 1, 1}), box({-3, 0, -0.1}, {3, 2, 0.1}), box({0, 0, 0}, {0.2, 5, 0.2}),
          box({0, 0, 0}, {4, 0.03, 3}), box({-1, -1, -9}, {0, 0, 0}),
          box({1000, 50, -2000}, {1000.01, 50.02, -1999.99})}) {
        const SceneProposal proposal = propose_scene(bounds);
        const Camera camera = camera_of(proposal);
        double most = 0;
        for (unsigned corner = 0; corner < 8; ++corner) {
            Point3 p;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = (corner >> axis & 1U) != 0 ? bounds.max[axis] : bounds.min[axis];
            EXPECT_TRUE(is_in_picture(camera, p));
            const auto pixel = camera.project(p);
            ASSERT_TRUE(pixel);
            const double x = std::abs(pixel->x / camera.width() - 0.5);
            const double y = std::abs(pixel->y / camera.height() - 0.5);
            most = std::max(most, std::max(x, y));
        }
        // Nine tenths of the picture are filled in one direction.
        EXPECT_NEAR(most, 0.45, 0.01);
        for (const ProposedLamp& lamp : proposal.lamps) {
            EXPECT_FALSE(is_in_picture(camera, lamp.position)) << lamp.name;
            EXPECT_GT(lamp.position.y, proposal.floor) << lamp.name;
            // Its beam holds the ball around the box.
            const double away = distance(lamp.position, proposal.target);
            EXPECT_GT(away * std::sin(glm::radians(lamp.beam / 2)), 0.5 * bounds.diagonal());
        }
        EXPECT_LT(proposal.floor, bounds.min.y);
        EXPECT_GT(proposal.eye.y, proposal.floor);
    }
}

TEST(SceneProposal, ALongBoxIsSeenFromItsSide) {
    const auto view = [](const Bounds& bounds) {
        const SceneProposal p = propose_scene(bounds);
        return glm::normalize(p.target - p.eye);
    };
    EXPECT_LT(std::abs(view(box({0, 0, 0}, {5, 1, 1})).x), 1e-9);
    EXPECT_LT(std::abs(view(box({0, 0, 0}, {1, 1, 5})).z), 1e-9);
}

TEST(SceneProposal, LengthsAreRoundedToTheSizeHoweverFarAway) {
    EXPECT_EQ(length_text(1.23456, 2), "1.235");
    EXPECT_EQ(length_text(0, 2), "0");
    EXPECT_EQ(length_text(-1e-9, 2), "0");
    EXPECT_EQ(length_text(5300000.1234, 2), "5300000.123");
    EXPECT_EQ(length_text(1234567, 5000), "1234567");
    EXPECT_EQ(length_text(0.00012345, 0.001), "0.000123");
}

}  // namespace
}  // namespace uw
