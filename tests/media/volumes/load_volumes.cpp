// ctest labels: unit
#include "media/volumes/load_volumes.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/hg_medium.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

class LoadVolumes : public testing::Test {
  protected:
    LoadVolumes() {
        fixture_.min = {-4, -4, -4};
        fixture_.max = {4, 4, 4};
        fixture_.value = [this](int, int, int) { return value_; };
        fixture_.file_from_index = Affine::scale(Vector3(0.05));
        desc_.file = dir_ / "cloud.vdb";
        desc_.where = "s.yaml:3: volumes[0]";
        desc_.grids.resize(1);
        desc_.grids[0].grid = "density";
        desc_.grids[0].where = desc_.where + ".grids.density";
    }
    LoadedVolume load(double per_unit = 1) {
        test::write_fixture(desc_.file, {fixture_});
        return load_volume(desc_, {{{0, per_unit}}});
    }
    std::string refusal(double per_unit = 1) {
        return test::message_of<InputError>([&] { load(per_unit); });
    }

    double value_ = 0.5;
    test::VdbFixture fixture_;
    VolumeDesc desc_;
    test::TempDir dir_;
};

TEST_F(LoadVolumes, TakeWhatIsSane) {
    EXPECT_EQ(load(1e6).reports.at(0).constituents.at(0).max, 5e5);
    fixture_.file_from_index = Affine::scale({0.5, 0.0005, 0.5});  // thin, but voxels
    EXPECT_EQ(load().grids.size(), 1U);
}

TEST_F(LoadVolumes, TellOfVoxelsOfManyOpticalDepths) {
    Medium medium = test::hg_medium(0, {0.1, 0.1}, {0.2, 0.2});
    test::add_particles(medium, {1, 2}, {3, 4});
    fixture_.file_from_index = Affine::scale({0.05, 0.1, 0.02});
    // At most 0.5 per unit, 6 1/m per ppm, 0.1 m: 0.3 optical depths per unit.
    // The warning begins at 4, told here to 1e-5, as far as 32-bit values tell it.
    const LoadedVolume thin = load(13.3333), dense = load(14);
    EXPECT_FALSE(coarse_voxel_warning(thin.reports.at(0), medium));
    EXPECT_TRUE(coarse_voxel_warning(load(13.33336).reports.at(0), medium));
    EXPECT_EQ(coarse_voxel_warning(dense.reports.at(0), medium)
                  .value_or("")
                  .find("cloud.vdb: grid 'density': its densest voxels are 4.2 optical depths"),
              0U);
}

TEST_F(LoadVolumes, RefuseValuesThatSumsCannotHold) {
    value_ = 3e38;
    EXPECT_EQ(refusal(1e-30).find("s.yaml:3: volumes[0].grids.density: the largest value of grid "
                                  "'density', 3e+38"),
              0U);
    value_ = 1e9;
    EXPECT_NE(refusal(1e4).find("makes a concentration of 1e+13"), std::string::npos);
}

TEST_F(LoadVolumes, RefuseVoxelsWithoutVolume) {
    fixture_.file_from_index = Affine::scale({0.1, 1e-8, 0.1});
    EXPECT_NE(refusal().find("its transform is singular"), std::string::npos);
    fixture_.file_from_index = Affine::scale(Vector3(0.1));
    desc_.world_from_upright = Affine::scale(Vector3(1e-11));
    EXPECT_NE(refusal().find("has voxels of 1e-12 x 1e-12 x 1e-12 m"), std::string::npos);
}

TEST_F(LoadVolumes, RefuseWhatReachesTooFar) {
    fixture_.file_from_index = Affine::scale(Vector3(4e6));
    EXPECT_EQ(refusal(),
              "s.yaml:3: volumes[0]: grid 'density' extends beyond 1e+07 m; check its transform");
    fixture_.file_from_index = Affine::translation({0, -2e7, 0}) * Affine::scale(Vector3(0.1));
    EXPECT_NE(refusal().find("extends beyond 1e+07 m"), std::string::npos);
}

}  // namespace
}  // namespace uw
