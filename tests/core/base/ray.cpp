// ctest labels: unit
#include "core/base/ray.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(Ray, GoesMetresAlongItsDirection) {
    const Ray ray{{1, 2, 3}, {0, -1, 0}};
    EXPECT_EQ(ray.at(0), (Point3{1, 2, 3}));
    EXPECT_EQ(ray.at(2.5), (Point3{1, -0.5, 3}));
    EXPECT_EQ((Interval{1.5, 4}).length(), 2.5);
}

TEST(Bounds, AreEmptyUntilExtended) {
    Bounds bounds;
    EXPECT_TRUE(bounds.empty());
    EXPECT_EQ(bounds.diagonal(), 0);
    bounds.extend(Bounds());
    EXPECT_TRUE(bounds.empty());
    bounds.extend(Point3{1, 2, 3});
    EXPECT_FALSE(bounds.empty());  // a point is a box of size 0
    EXPECT_EQ(bounds.min, (Point3{1, 2, 3}));
    EXPECT_EQ(bounds.max, (Point3{1, 2, 3}));
    EXPECT_EQ(bounds.diagonal(), 0);
}

TEST(Bounds, HoldAllThatTheyWereExtendedBy) {
    Bounds bounds;
    bounds.extend(Point3{0, 5, -1});
    bounds.extend(Point3{2, 2, 5});
    EXPECT_EQ(bounds.min, (Point3{0, 2, -1}));
    EXPECT_EQ(bounds.max, (Point3{2, 5, 5}));
    EXPECT_EQ(bounds.center(), (Point3{1, 3.5, 2}));
    EXPECT_EQ(bounds.diagonal(), 7);  // 2, 3, 6
    Bounds other;
    other.extend(Point3{-1, 3, 9});
    bounds.extend(other);
    EXPECT_EQ(bounds.min, (Point3{-1, 2, -1}));
    EXPECT_EQ(bounds.max, (Point3{2, 5, 9}));
}

TEST(Bounds, OneAxisUpsideDownIsEmpty) {
    for (int axis = 0; axis < 3; ++axis) {
        Bounds bounds{{0, 0, 0}, {1, 1, 1}};
        bounds.min[axis] = 2;
        EXPECT_TRUE(bounds.empty());
        EXPECT_EQ(bounds.diagonal(), 0);
    }
}

}  // namespace
}  // namespace uw
