// ctest labels: unit
#include "core/light/medium.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(ConcentrationProfile, IsEmptyBetweenKnotsWhereNoConstituentIs) {
    ConcentrationProfile profile;
    profile.constituent_count = 2;
    profile.s = {0, 1, 2, 3, 4};
    profile.concentration = {0, 0, 0, 0, 0, 0.5, 0, 0, 0, 0};  // the second at the third knot
    profile.column.resize(10);
    EXPECT_TRUE(profile.empty_between(0));
    EXPECT_FALSE(profile.empty_between(1));
    EXPECT_FALSE(profile.empty_between(2));
    EXPECT_TRUE(profile.empty_between(3));
}

TEST(ConcentrationProfile, WithoutConstituentsIsEmptyAllAlong) {
    ConcentrationProfile profile;
    profile.s = {0, 5};
    EXPECT_TRUE(profile.empty_between(0));
}

}  // namespace
}  // namespace uw
