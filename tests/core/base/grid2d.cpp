// ctest labels: unit
#include "core/base/grid2d.h"

#include <gtest/gtest.h>

#include <numeric>

namespace uw::test {
namespace {

TEST(Grid2D, RowsFollowEachOtherFromTheTop) {
    Grid2D<int> grid(3, 2);
    std::iota(grid.begin(), grid.end(), 0);
    EXPECT_EQ(grid(0, 0), 0);
    EXPECT_EQ(grid(2, 0), 2);
    EXPECT_EQ(grid(0, 1), 3);
    EXPECT_EQ(grid(1, 1), 4);
    EXPECT_EQ(grid.index(2, 1), 5U);
    EXPECT_EQ(grid[grid.index(2, 1)], grid(2, 1));
    EXPECT_EQ(grid.row(1).size(), 3U);
    EXPECT_EQ(&grid.row(1)[2], &grid(2, 1));
    EXPECT_EQ(grid.values().size(), 6U);
}

TEST(Grid2D, AssigningSetsEveryValue) {
    Grid2D<float> grid(2, 2, 7);
    EXPECT_EQ(grid(1, 1), 7);
    grid(1, 1) = 9;
    grid.assign(1, 3, 2);
    EXPECT_EQ(grid.width(), 1);
    EXPECT_EQ(grid.height(), 3);
    for (const float value : grid) EXPECT_EQ(value, 2);
}

TEST(Grid2D, HoldsNothingAtFirst) {
    const Grid2D<double> grid;
    EXPECT_TRUE(grid.empty());
    EXPECT_EQ(grid.size(), 0U);
}

}  // namespace
}  // namespace uw::test
