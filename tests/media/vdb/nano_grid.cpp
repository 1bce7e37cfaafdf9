// ctest labels: unit
#include "media/vdb/nano_grid.h"

#include <gtest/gtest.h>

#include "media/volumes/grid_field.h"
#include "tests/support/field_maker.h"

namespace uw {
namespace {

double stored_sum(const ConcentrationField& field) {
    double sum = 0;
    for (const GridVolume& volume : dynamic_cast<const GridField&>(field).volumes())
        for (const NanoGrid& brick : volume.bricks()) sum += brick.stored_sum();
    return sum;
}

TEST(NanoGrid, StoredSumIsThatOfEveryVoxel) {
    double expected = 0, voxels = 0;
    for (int i = -9; i <= 10; ++i)
        for (int j = -3; j <= 14; ++j)
            for (int k = -6; k <= 15; ++k, ++voxels) expected += test::bumpy(i, j, k);
    test::FieldMaker maker;
    // Rounding of 16-bit values is far below half a quantum in the mean.
    const double tolerance = test::k_quantum * voxels;
    EXPECT_NEAR(stored_sum(*maker.field(test::bumpy_fixture())), expected, tolerance);
    // Cut into bricks, no voxel is counted twice or left out.
    const auto bricks =
        maker.field(test::bumpy_fixture(), Centering::node, UpAxis::y, std::size_t{4096});
    EXPECT_NEAR(stored_sum(*bricks), expected, tolerance);
}

}  // namespace
}  // namespace uw
