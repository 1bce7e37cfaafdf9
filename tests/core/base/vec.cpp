// ctest labels: unit
#include "core/base/vector_math.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace uw {
namespace {

template <class A, class B>
concept CanBeAdded = requires(const A& a, const B& b) {
    a + b;
};

TEST(Vec, PointsAndVectorsDoNotMix) {
    static_assert(!CanBeAdded<Point3, Point3>);
    static_assert(std::is_same_v<decltype(Point3() - Point3()), Vector3>);
    static_assert(std::is_same_v<decltype(Point3() + Vector3()), Point3>);
    static_assert(!std::is_convertible_v<Point3, Vector3> &&
                  !std::is_convertible_v<Vector3, Point3>);
}

TEST(Vec, SumsAndDifferences) {
    const Point3 a{1, 2, 3}, b{4, 6, 3};
    EXPECT_EQ(b - a, Vector3(3, 4, 0));
    EXPECT_EQ(a + (b - a), b);
    EXPECT_EQ(b - (b - a), a);
    EXPECT_EQ(distance(a, b), 5);
    EXPECT_EQ(from_origin(a), Vector3(1, 2, 3));
    EXPECT_EQ(at_origin_plus(from_origin(a)), a);
}

TEST(Vec, AnglesAreExactNearTheirEnds) {
    const Vector3 x{2, 0, 0};
    EXPECT_EQ(angle_between(x, {3, 0, 0}), 0);
    EXPECT_EQ(angle_between(x, {-3, 0, 0}), std::numbers::pi);
    EXPECT_DOUBLE_EQ(angle_between(x, {0, 0, 5}), std::numbers::pi / 2);
    EXPECT_DOUBLE_EQ(angle_between(x, {1, 1e-9, 0}), 1e-9);  // whose cosine rounds to 1
}

TEST(Vec, ComponentsByAxis) {
    Point3 p{1, 2, 3};
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(p[axis], axis + 1);
        p[axis] = -axis;
    }
    EXPECT_EQ(p, (Point3{0, -1, -2}));
}

}  // namespace
}  // namespace uw
