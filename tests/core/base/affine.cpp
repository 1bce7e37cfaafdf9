// ctest labels: unit
#include "core/base/vector_math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uw {
namespace {

void expect_same_vector(const Vector3& a, const Vector3& b) {
    EXPECT_LT(glm::length(a - b), 1e-14)
        << a.x << " " << a.y << " " << a.z << " for " << b.x << " " << b.y << " " << b.z;
}

void expect_same_map(const Affine& a, const Affine& b) {
    for (int column = 0; column < 3; ++column)
        expect_same_vector(a.linear()[column], b.linear()[column]);
    expect_same_vector(a.offset(), b.offset());
}

Affine sheared_and_moved() {
    return {Matrix3(2, 0.3, -0.1, 0.4, 1.5, 0.2, 0.1, -0.6, 3), {1, -2, 0.5}};
}

TEST(Affine, TurnsAboutEachAxisByTheRightHand) {
    // A quarter turn takes each axis to the next one: y to z about x, z to x about y, x to y
    // about z.
    expect_same_vector(Affine::rotation_xyz_degrees({90, 0, 0}).apply_to_vector({0, 1, 0}),
                       {0, 0, 1});
    expect_same_vector(Affine::rotation_xyz_degrees({0, 90, 0}).apply_to_vector({0, 0, 1}),
                       {1, 0, 0});
    expect_same_vector(Affine::rotation_xyz_degrees({0, 0, 90}).apply_to_vector({1, 0, 0}),
                       {0, 1, 0});
    const double root = std::sqrt(0.75);
    expect_same_vector(Affine::rotation_xyz_degrees({0, 0, 30}).apply_to_vector({1, 0, 0}),
                       {root, 0.5, 0});
}

TEST(Affine, TurnsAboutXFirstAndZLast) {
    const Affine x = Affine::rotation_xyz_degrees({20, 0, 0});
    const Affine y = Affine::rotation_xyz_degrees({0, -35, 0});
    const Affine z = Affine::rotation_xyz_degrees({0, 0, 50});
    expect_same_map(Affine::rotation_xyz_degrees({20, -35, 50}), z * y * x);
}

TEST(Affine, RotationsKeepLengthsAndHandedness) {
    const Affine turn = Affine::rotation_xyz_degrees({12, 34, 56});
    EXPECT_NEAR(turn.determinant(), 1, 1e-15);
    expect_same_map(Affine(glm::transpose(turn.linear()), Vector3(0)), turn.inverse());
}

TEST(Affine, AProductAppliesTheRightHandSideFirst) {
    const Affine move = Affine::translation({1, 2, 3}), scale = Affine::scale({2, 3, 4});
    EXPECT_EQ((move * scale) * (Point3{1, 1, 1}), (Point3{3, 5, 7}));
    EXPECT_EQ((scale * move) * (Point3{1, 1, 1}), (Point3{4, 9, 16}));
}

TEST(Affine, DisplacementsAreNotMoved) {
    const Affine map = sheared_and_moved();
    const Point3 a{1, 2, 3}, b{-0.5, 4, 1};
    expect_same_vector(map.apply_to_vector(b - a), map * b - map * a);
    expect_same_vector(Affine::translation({9, 9, 9}).apply_to_vector({1, 2, 3}), {1, 2, 3});
}

TEST(Affine, TheInverseUndoesTheMap) {
    const Affine map = sheared_and_moved();
    expect_same_map(map.inverse() * map, Affine());
    expect_same_map(map * map.inverse(), Affine());
}

TEST(Affine, NormalsStayAcrossTheirSurface) {
    // Two directions in a surface keep the normal across them, whatever the map does to lengths.
    const Affine map = sheared_and_moved();
    const Vector3 u(1, 0.5, -2), v(0.3, -1, 0.4);
    const Vector3 normal = map.apply_to_normal(glm::cross(u, v));
    EXPECT_NEAR(glm::length(normal), 1, 1e-15);
    EXPECT_NEAR(glm::dot(normal, map.apply_to_vector(u)), 0, 1e-14);
    EXPECT_NEAR(glm::dot(normal, map.apply_to_vector(v)), 0, 1e-14);
    // A plane through the x axis at 45 degrees, squeezed to a fifth of its height.
    expect_same_vector(Affine::scale({1, 1, 0.2}).apply_to_normal({0, 1, 1}),
                       glm::normalize(Vector3(0, 1, 5)));
}

TEST(Affine, DeterminantIsTheVolumeWithItsSign) {
    EXPECT_DOUBLE_EQ(Affine::scale({2, -3, 4}).determinant(), -24);
    EXPECT_EQ(Affine::translation({5, 6, 7}).determinant(), 1);
}

}  // namespace
}  // namespace uw
