// ctest labels: unit
#include "media/volumes/loaded_grid.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

VdbHeader blender_cache() {
    VdbHeader header;
    header.grids.emplace_back();
    header.grids[0].base_resolution = {128, 64, 51};
    return header;
}

TEST(Placement, AutomaticIsBlendersForItsCaches) {
    const Placement blender = decide_placement(blender_cache(), VolumeDesc());
    EXPECT_EQ(blender.centering, Centering::cell);
    EXPECT_EQ(blender.up, UpAxis::z);
    EXPECT_TRUE(blender.automatic_centering && blender.automatic_up);
    const Placement other = decide_placement(VdbHeader(), VolumeDesc());
    EXPECT_EQ(other.centering, Centering::node);
    EXPECT_EQ(other.up, UpAxis::y);
    EXPECT_TRUE(other.automatic_centering && other.automatic_up);
}

TEST(Placement, WhatTheSceneSaysStands) {
    VolumeDesc desc;
    desc.centering = Centering::node;
    const Placement placement = decide_placement(blender_cache(), desc);
    EXPECT_EQ(placement.centering, Centering::node);
    EXPECT_FALSE(placement.automatic_centering);
    EXPECT_EQ(placement.up, UpAxis::z);
    EXPECT_TRUE(placement.automatic_up);
    desc.up = UpAxis::z;
    EXPECT_EQ(decide_placement(VdbHeader(), desc).up, UpAxis::z);
    EXPECT_FALSE(decide_placement(VdbHeader(), desc).automatic_up);
}

TEST(Placement, ZUpIsTurnedToYUpWithoutMirroring) {
    const Affine upright = upright_from_file(UpAxis::z);
    EXPECT_EQ(upright * (Point3{1, 2, 3}), (Point3{1, 3, -2}));
    EXPECT_EQ(upright.determinant(), 1);
    const Affine from_x = upright_from_file(UpAxis::x);
    EXPECT_EQ(from_x * Point3(1, 2, 3), Point3(3, 1, 2));
    EXPECT_EQ(from_x.determinant(), 1);
    EXPECT_EQ(upright_from_file(UpAxis::y), Affine());
}

TEST(Placement, TheScenesTransformComesLast) {
    LoadedGrid grid;
    grid.file_from_index = Affine::scale(Vector3(0.5));
    Placement placement;
    placement.up = UpAxis::z;
    const Affine map = world_from_index(grid, placement, Affine::translation({10, 20, 30}));
    EXPECT_EQ(map * (Point3{2, 4, 6}), (Point3{11, 23, 28}));
}

}  // namespace
}  // namespace uw
