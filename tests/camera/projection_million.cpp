// ctest labels: slow
#include <gtest/gtest.h>

#include <iostream>

#include "tests/support/projection_cases.h"

namespace uw {
namespace {

TEST(ProjectionOfAMillionPoints, AllSucceedWithinAMillionthOfAPixel) {
    for (const auto& [name, desc] : test::projection_cameras()) {
        const test::ProjectionTally tally = test::tally_projections(desc, 1000000);
        std::cout << name << ": " << tally.points - tally.failures << " of " << tally.points
                  << " projected, worst error " << tally.worst << " pixels\n";
        EXPECT_EQ(tally.failures, 0) << name;
        EXPECT_LT(tally.worst, 1e-6) << name;  // asked for by physics.md, section 3
    }
}

}  // namespace
}  // namespace uw
