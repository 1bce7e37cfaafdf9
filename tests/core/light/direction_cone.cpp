// ctest labels: unit analytic
#include "core/light/lamp_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/random_direction.h"

namespace uw::test {
namespace {

TEST(DirectionCone, HasWhatLiesWithinItsAngle) {
    std::mt19937 rng(5);
    for (int n = 0; n < 2000; ++n) {
        const Vector3 axis = random_direction(rng), direction = 3.0 * random_direction(rng);
        const double angle = std::acos(glm::dot(axis, direction) / 3.0);
        EXPECT_TRUE((DirectionCone{axis, -1}.has(direction)));
        EXPECT_TRUE((DirectionCone{axis, -1}.has(-axis)));
        for (const double half : {0.3, 1.2, 2.0, 3.0}) {
            EXPECT_EQ((DirectionCone{axis, std::cos(half)}.has(direction)), angle <= half);
            EXPECT_EQ((DirectionCone{axis, std::cos(half)}.widened(0.1).has(direction)),
                      angle <= half + 0.1);
        }
        EXPECT_TRUE((DirectionCone{axis, -1}.includes({direction / 3.0, 0.5})));
        EXPECT_EQ((DirectionCone{axis, std::cos(1.2)}.includes({direction / 3.0, std::cos(0.3)})),
                  angle + 0.3 <= 1.2);
    }
}

}  // namespace
}  // namespace uw::test
