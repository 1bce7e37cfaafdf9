// ctest labels: unit
#include "media/inspection/vdb_inspect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using test::VdbFixture;

class VdbInspect : public testing::Test {
  protected:
    VdbInspection inspect(const std::vector<VdbFixture>& grids) const {
        test::write_fixture(dir_ / "a.vdb", grids);
        return inspect_vdb(dir_ / "a.vdb", test::k_where);
    }
    test::TempDir dir_;
};

TEST_F(VdbInspect, SummarisesTheActiveValuesAsTheyAre) {
    VdbFixture fixture = test::single_voxel("density");
    fixture.max = {6, 1, 1};
    fixture.value = [](int i, int, int) {
        const double values[] = {0, 1, 2, -3, NAN, INFINITY, 4};
        return values[i];
    };
    const VdbInspection inspection = inspect({fixture});
    const GridInspection& grid = inspection.grids.at(0);
    ASSERT_TRUE(grid.values);
    EXPECT_EQ(grid.active_voxels, 6);
    EXPECT_EQ(grid.values->finite, 4);
    EXPECT_EQ(grid.values->nan, 1);
    EXPECT_EQ(grid.values->infinite, 1);
    EXPECT_EQ(grid.values->negative, 1);
    EXPECT_EQ(grid.values->min, -3);
    EXPECT_EQ(grid.values->max, 4);
    EXPECT_EQ(grid.values->mean, 1);
    const auto& bins = grid.values->histogram;
    EXPECT_EQ(bins.size(), static_cast<std::size_t>(k_histogram_bins));
    EXPECT_EQ(std::accumulate(bins.begin(), bins.end(), std::int64_t{0}), 4);
    EXPECT_EQ(bins.front(), 1);
    EXPECT_EQ(bins.back(), 1);
}

TEST_F(VdbInspect, NamesTheKindOfTransform) {
    const Affine turn = Affine::rotation_xyz_degrees({0, 0, 30});
    for (const auto& [map, kind] :
         {std::pair(Affine::scale({0.5, 0.5, 0.5}), "uniform scale"),
          {Affine::scale({0.5, 0.25, 0.5}), "scale"},
          {Affine::scale({0.5, -0.5, 0.5}), "uniform scale, mirrored"},
          {turn * Affine::scale({0.5, 0.5, 0.5}), "rotated, uniform scale"},
          {turn * Affine::scale({1, 2, 3}), "rotated, scale"},
          {Affine(Matrix3(1, 0, 0, 0.5, 1, 0, 0, 0, 1), Vector3(0)), "sheared"}}) {
        VdbFixture fixture = test::single_voxel("density");
        fixture.file_from_index = map;
        EXPECT_EQ(inspect({fixture}).grids.at(0).transform, kind);
    }
}

TEST_F(VdbInspect, BoundsHoldTheActiveVoxelsCells) {
    VdbFixture fixture = test::single_voxel("density");
    fixture.min = {0, 0, 0};
    fixture.max = {3, 1, 0};
    fixture.file_from_index = Affine::translation({10, 0, 0}) * Affine::scale({0.5, 1, 2});
    const GridInspection grid = inspect({fixture}).grids.at(0);
    EXPECT_EQ(grid.world_bounds.min, (Point3{9.75, -0.5, -1}));
    EXPECT_EQ(grid.world_bounds.max, (Point3{11.75, 1.5, 1}));
    EXPECT_EQ(grid.voxel_size, Vector3(0.5, 1, 2));
}

TEST_F(VdbInspect, SaysWhatIsNoConcentration) {
    test::write_vector_grid(dir_ / "v.vdb");
    const VdbInspection vectors = inspect_vdb(dir_ / "v.vdb", test::k_where);
    EXPECT_NE(vectors.grids.at(0).unusable.find("holds vectors"), std::string::npos);
    EXPECT_TRUE(vectors.grids.at(0).values);  // their lengths
    test::write_frustum_grid(dir_ / "f.vdb");
    EXPECT_EQ(inspect_vdb(dir_ / "f.vdb", test::k_where).grids.at(0).transform, "frustum");
}

TEST_F(VdbInspect, OneBrokenGridLeavesTheOthers) {
    const auto wavy = [](const char* name) {
        VdbFixture fixture = test::single_voxel(name);
        fixture.max = {20, 20, 20};
        fixture.value = [](int i, int j, int k) { return 2 + std::sin(9.1 * i + 7.3 * j + k); };
        return fixture;
    };
    test::write_fixture(dir_ / "a.vdb", {wavy("first"), wavy("second")});
    std::string bytes = test::file_bytes(dir_ / "a.vdb");
    for (std::size_t at = bytes.size() - 3000; at < bytes.size() - 500; ++at) bytes[at] = '\xfe';
    test::write_file_bytes(dir_ / "broken.vdb", bytes);
    const VdbInspection inspection = inspect_vdb(dir_ / "broken.vdb", test::k_where);
    ASSERT_EQ(inspection.grids.size(), 2U);
    EXPECT_EQ(inspection.grids[0].unread, "");
    EXPECT_NE(inspection.grids[1].unread, "");
    test::write_file_bytes(dir_ / "text.vdb", "no volume at all");
    EXPECT_NE(test::message_of<InputError>([&] {
                  inspect_vdb(dir_ / "text.vdb", test::k_where);
              }).find("is not a VDB file"),
              std::string::npos);
}

}  // namespace
}  // namespace uw
