// ctest labels: unit metamorphic
#include "media/volumes/grid_field.h"

#include <gtest/gtest.h>

#include "tests/support/field_maker.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

class GridVolumeTest : public testing::Test {
  protected:
    /// One voxel of value 2 at index (1, 1, 1).
    GridVolume volume(const Affine& world_from_index, Centering centering) const {
        test::write_fixture(dir_ / "a.vdb", {test::single_voxel("density", 2)});
        return {test::load(dir_ / "a.vdb", "density").bricks,
                world_from_index,
                centering,
                {GridLoad{0, 1.5}}};
    }
    test::TempDir dir_;
};

const Affine k_centimetres = Affine::translation({0, 0, 3}) * Affine::scale({0.01, 0.02, 0.04});

TEST_F(GridVolumeTest, NodesSitAtTheirIndexAndCellsHalfAVoxelFurther) {
    const GridVolume node = volume(k_centimetres, Centering::node);
    EXPECT_NEAR(node.value({0.01, 0.02, 3.04}), 2, 1e-12);
    EXPECT_NEAR(node.value({0.015, 0.02, 3.04}), 1, 1e-12);
    const GridVolume cell = volume(k_centimetres, Centering::cell);
    EXPECT_NEAR(cell.value({0.015, 0.03, 3.06}), 2, 1e-12);
}

TEST_F(GridVolumeTest, BoundsHoldTheInterpolantAndVoxelsTheirCells) {
    const GridVolume node = volume(k_centimetres, Centering::node);
    const auto expect_box = [](const Bounds& bounds, const Point3& min, const Point3& max) {
        EXPECT_LT(distance(bounds.min, min), 1e-12);
        EXPECT_LT(distance(bounds.max, max), 1e-12);
    };
    expect_box(node.bounds(), {0, 0, 3}, {0.02, 0.04, 3.08});
    expect_box(node.voxel_bounds(), {0.005, 0.01, 3.02}, {0.015, 0.03, 3.06});
    EXPECT_LT(glm::length(node.voxel_size() - Vector3(0.01, 0.02, 0.04)), 1e-15);
    ASSERT_EQ(node.loads().size(), 1U);
    EXPECT_EQ(node.loads()[0].per_unit, 1.5);
}

TEST_F(GridVolumeTest, ColumnsAreInMetres) {
    // A tent of height 2 over two voxels along x: an area of 2 voxels.
    const GridVolume node = volume(k_centimetres, Centering::node);
    EXPECT_NEAR(node.column({-1, 0.02, 3.04}, {1, 0.02, 3.04}), 2 * 0.01, 1e-12);
    EXPECT_NEAR(node.column({0.01, -1, 3.04}, {0.01, 1, 3.04}), 2 * 0.02, 1e-12);
    EXPECT_NEAR(node.column({0.01, 0.02, 3.08}, {0.01, 0.02, 3.04}), 0.04, 1e-12);  // half, back
    EXPECT_EQ(node.column({1, 1, 1}, {1, 1, 1}), 0);
}

TEST_F(GridVolumeTest, TurningTheGridTurnsItsBoxAndKeepsItsColumns) {
    const Affine turn = Affine::rotation_xyz_degrees({0, 0, 30});
    const GridVolume turned = volume(turn * k_centimetres, Centering::node);
    const GridVolume straight = volume(k_centimetres, Centering::node);
    const Point3 a{-0.02, 0.015, 3.03}, b{0.05, 0.03, 3.06};
    EXPECT_NEAR(turned.column(turn * a, turn * b), straight.column(a, b), 1e-12);
    EXPECT_LT(glm::length(turned.voxel_size() - straight.voxel_size()), 1e-15);
    Bounds corners;
    for (const double x : {0.0, 0.02})
        for (const double y : {0.0, 0.04})
            for (const double z : {3.0, 3.08}) corners.extend(turn * Point3{x, y, z});
    EXPECT_LT(distance(turned.bounds().min, corners.min), 1e-12);
    EXPECT_LT(distance(turned.bounds().max, corners.max), 1e-12);
}

TEST_F(GridVolumeTest, WithoutBricksIsNothingNowhere) {
    const GridVolume nothing({}, k_centimetres, Centering::node, {});
    EXPECT_TRUE(nothing.bounds().empty());
    EXPECT_EQ(nothing.value({0, 0, 3}), 0);
    EXPECT_EQ(nothing.column({0, 0, 0}, {1, 1, 9}), 0);
}

TEST_F(GridVolumeTest, BricksAddUp) {
    test::VdbFixture bumpy = test::bumpy_fixture();
    test::write_fixture(dir_ / "b.vdb", {bumpy});
    const GridVolume one(test::load(dir_ / "b.vdb", "density").bricks, Affine(), Centering::node,
                         {});
    const GridVolume many(test::load(dir_ / "b.vdb", "density", 4096).bricks, Affine(),
                          Centering::node, {});
    EXPECT_GT(many.bricks().size(), one.bricks().size());
    EXPECT_NEAR(many.value({0.3, 2.7, 3.1}), one.value({0.3, 2.7, 3.1}), test::k_quantum);
    const Point3 a{-12, -4, -8}, b{12, 16, 17};
    EXPECT_NEAR(many.column(a, b), one.column(a, b), 50 * test::k_quantum);
}

}  // namespace
}  // namespace uw
