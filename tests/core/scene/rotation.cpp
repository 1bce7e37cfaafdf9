// ctest labels: unit analytic
#include "core/scene/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace uw {
namespace {

void expect_same(const Matrix3& a, const Matrix3& b) {
    for (int i = 0; i < 3; ++i) EXPECT_LT(glm::length(a[i] - b[i]), 1e-14);
}

TEST(Rotations, AreThoseOfTheirMatrices) {
    // A quarter turn about z takes x to y, about x takes y to z.
    const double r = std::numbers::sqrt2 / 2;
    expect_same(Rotation{r, 0, 0, r}.matrix(), Matrix3(0, 1, 0, -1, 0, 0, 0, 0, 1));
    expect_same(Rotation{r, r, 0, 0}.matrix(), Matrix3(1, 0, 0, 0, 0, 1, 0, -1, 0));
    // Applied from right to left, as matrices are.
    const Rotation a = normalised({1, 2, -3, 0.5}), b = normalised({-0.3, 0.2, 0.9, 4});
    expect_same((a * b).matrix(), a.matrix() * b.matrix());
    expect_same((a * a.inverse()).matrix(), Matrix3(1.0));
}

TEST(Rotations, ComeBackFromMatricesAndVectors) {
    // Every component may be the largest, and the angle anything up to half a turn.
    for (const Vector3 axis :
         {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1), glm::normalize(Vector3(1, -2, 3))})
        for (const double angle : {0.0, 1e-12, 1e-5, 0.3, 2.0, 3.14159}) {
            const Rotation q = rotation_by(angle * axis);
            EXPECT_NEAR(q.w, std::cos(angle / 2), 1e-15);
            expect_same(rotation_of(q.matrix()).matrix(), q.matrix());
            EXPECT_LT(glm::length(rotation_vector(q) - angle * axis), 1e-15 + 1e-14 * angle);
            EXPECT_LT(glm::length(rotation_vector({-q.w, -q.x, -q.y, -q.z}) - angle * axis),
                      1e-15 + 1e-14 * angle);
        }
}

}  // namespace
}  // namespace uw
