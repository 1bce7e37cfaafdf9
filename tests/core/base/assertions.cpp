// ctest labels: unit slow
// Assertions are on in the preset asan alone, of which a suite runs this.
#include <gtest/gtest.h>

#include "core/base/grid2d.h"

namespace uw::test {
namespace {

TEST(AssertionsDeathTest, APlaceOutsideAGridIsAFault) {
#ifdef NDEBUG
    FAIL() << "this build has no assertions; use the preset asan";
#endif
    const Grid2D<int> grid(3, 2);
    EXPECT_DEATH(static_cast<void>(grid(3, 0)), "x < width_");
    EXPECT_DEATH(static_cast<void>(grid(0, 2)), "y < height_");
    EXPECT_DEATH(static_cast<void>(grid.row(-1)), "y >= 0");
}

}  // namespace
}  // namespace uw::test
