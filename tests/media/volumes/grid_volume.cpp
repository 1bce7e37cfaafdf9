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
    GridVolume volume(const Affine& world_from_index) const {
        test::write_fixture(dir_ / "a.vdb", {test::single_voxel("density", 2)});
        return {test::load(dir_ / "a.vdb", "density").bricks,
                world_from_index,
                Centering::node,
                {GridLoad{0, 1.5}}};
    }
    test::TempDir dir_;
};

const Affine k_centimetres = Affine::translation({0, 0, 3}) * Affine::scale({0.01, 0.02, 0.04});

TEST_F(GridVolumeTest, BoundsHoldTheInterpolantAndVoxelsTheirCells) {
    const GridVolume node = volume(k_centimetres);
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

TEST_F(GridVolumeTest, TurningTheGridTurnsItsBoxAndKeepsItsColumns) {
    const Affine turn = Affine::rotation_xyz_degrees({0, 0, 30});
    const GridVolume turned = volume(turn * k_centimetres);
    const GridVolume straight = volume(k_centimetres);
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

}  // namespace
}  // namespace uw
