// ctest labels: unit
#include "media/volumes/block_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/field_maker.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using nanovdb::Coord;

NanoGrid loaded(const test::VdbFixture& fixture) {
    const test::TempDir folder;
    test::write_fixture(folder.path() / "a.vdb", {fixture});
    return test::load(folder.path() / "a.vdb", fixture.name).bricks.at(0);
}

/// A block of voxels, tiles of 8 and 128 voxels, and single voxels in the first and the last corner
/// of blocks.
test::VdbFixture scattered() {
    test::VdbFixture fixture = test::bumpy_fixture();
    fixture.boxes = {{{64, 0, 0}, {71, 7, 7}, 0.5},
                     {{128, 128, -128}, {255, 255, -1}, 0.25},
                     {{-40, 64, 16}, {-40, 64, 16}, 1},
                     {{111, 47, 95}, {111, 47, 95}, 1},
                     {{-64, -64, 31}, {-64, -64, 31}, 1}};
    return fixture;
}

TEST(BlockMap, KnowsWhereTheInterpolantIsZero) {
    const NanoGrid grid = loaded(scattered());
    const auto* const typed = static_cast<const BlockMap::Grid*>(grid.data());
    const auto map = BlockMap::of(*typed, grid.support());
    ASSERT_NE(map, nullptr);
    const auto accessor = typed->getAccessor();
    // It and the blocks that follow it, which its cells have corners in.
    const auto is_zero = [&](const Coord& low) {
        for (int side = 0; side < 8; ++side) {
            const Coord voxel = low.offsetBy((side & 4) * 2, (side & 2) * 4, (side & 1) * 8);
            if (accessor.probeLeaf(voxel) != nullptr || accessor.getValue(voxel) != 0) return false;
        }
        return true;
    };
    int leaps = 0;
    Coord at;
    for (at[0] = -88; at[0] < 280; at[0] += 8)
        for (at[1] = -88; at[1] < 280; at[1] += 8)
            for (at[2] = -152; at[2] < 120; at[2] += 8) {
                const bool is_empty = is_zero(at);
                const Coord cell = at.offsetBy(3, 7, 0);
                const BlockMap::Kind kind = map->kind(cell);
                ASSERT_EQ(kind == BlockMap::Kind::empty, is_empty) << at[0] << " " << at[1];
                ASSERT_EQ(kind == BlockMap::Kind::voxels, accessor.probeLeaf(cell) != nullptr);
                ASSERT_EQ(kind == BlockMap::Kind::tile,
                          accessor.probeLeaf(cell) == nullptr && accessor.getValue(cell) != 0);
                if (!is_empty) continue;
                Coord low, high;
                map->find_empty(cell, low, high);
                const int edge = high[0] - low[0];
                ASSERT_TRUE(edge >= 8 && edge % 16 == 8);
                for (int axis = 0; axis < 3; ++axis) {
                    ASSERT_EQ(high[axis] - low[axis], edge);
                    ASSERT_EQ(low[axis] + edge / 2 - 4, at[axis]);
                }
                if (edge == 8 || ++leaps % 50 != 0) continue;
                // The boxes reach as far as they can: one block more on all sides is too much.
                const auto box_is_zero = [&](int beyond) {
                    Coord block;
                    for (block[0] = at[0] - beyond; block[0] <= at[0] + beyond; block[0] += 8)
                        for (block[1] = at[1] - beyond; block[1] <= at[1] + beyond; block[1] += 8)
                            for (block[2] = at[2] - beyond; block[2] <= at[2] + beyond;
                                 block[2] += 8)
                                if (map->kind(block) != BlockMap::Kind::empty) return false;
                    return true;
                };
                ASSERT_TRUE(box_is_zero(edge / 2 - 4));
                ASSERT_FALSE(box_is_zero(edge / 2 + 4));
            }
    EXPECT_GT(leaps, 1000);
}

TEST(BlockMap, IsLeftOutWhereItWouldBeLargerThanTheGrid) {
    test::VdbFixture fixture;
    fixture.boxes = {{{0, 0, 0}, {0, 0, 0}, 1}, {{2000, 2000, 2000}, {2000, 2000, 2000}, 1}};
    const NanoGrid grid = loaded(fixture);
    EXPECT_EQ(BlockMap::of(*static_cast<const BlockMap::Grid*>(grid.data()), grid.support()),
              nullptr);
}

}  // namespace
}  // namespace uw
