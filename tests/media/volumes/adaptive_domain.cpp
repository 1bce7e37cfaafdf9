// ctest labels: unit
#include "media/volumes/fluid_domain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "core/base/error.h"
#include "media/volumes/load_volumes.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/fluid_configs.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

class AdaptiveDomainTest : public testing::Test {
  protected:
    /// A frame as the solver writes it: voxels of the domain's longest side divided by the longest
    /// side of its own grid.
    VolumeDesc write(const std::string& name, std::array<int, 3> resolution,
                     const test::VdbBox& box = {{4, 4, 4}, {11, 11, 11}, 1}) const {
        constexpr double k_longest_side = 2.4;
        test::VdbFixture fixture;
        fixture.boxes = {box};
        fixture.blender_metadata = true;
        fixture.base_resolution = resolution;
        fixture.file_from_index =
            Affine::scale(Vector3(k_longest_side / *std::ranges::max_element(resolution)));
        test::write_fixture(dir_ / name, {fixture}, "");
        VolumeDesc desc;
        desc.file = dir_ / name;
        desc.where = test::k_where;
        desc.grids.resize(1);
        desc.grids[0].grid = "density";
        desc.grids[0].where = desc.where;
        return desc;
    }
    std::optional<FluidDomain> find(const VolumeDesc& frame) const {
        return find_fluid_domain(read_vdb_header(frame.file, frame.where));
    }
    static LoadedVolume load(const VolumeDesc& desc) {
        return load_volume(desc, {{GridLoad{0, 1.0}}});
    }
    test::TempDir dir_;
};

TEST_F(AdaptiveDomainTest, IsToldByFramesOfOtherResolution) {
    const VolumeDesc small = write("data_0001.vdb", {20, 20, 24});
    const VolumeDesc large = write("data_0007.vdb", {40, 30, 22});
    for (const VolumeDesc& frame : {small, large}) {
        const auto domain = find(frame);
        ASSERT_TRUE(domain);
        EXPECT_NEAR(domain->longest_side, 2.4, 1e-9);
        EXPECT_EQ(domain->max_voxels, 40);
        EXPECT_NEAR(domain->max_voxel(), 0.06, 1e-9);
        const LoadedVolume volume = load(frame);
        ASSERT_EQ(volume.warnings.size(), 1U);
        EXPECT_NE(volume.warnings[0].find("Adaptive Domain"), std::string::npos);
    }
}

TEST_F(AdaptiveDomainTest, FramesOfOneResolutionAreNone) {
    const VolumeDesc frame = write("data_0001.vdb", {48, 48, 24});
    write("data_0002.vdb", {48, 48, 24});
    write("other_0003.vdb", {24, 24, 24});  // not of this sequence
    EXPECT_FALSE(find(frame));
    EXPECT_TRUE(load(frame).warnings.empty());
    EXPECT_FALSE(find(write("single.vdb", {48, 48, 24})));
}

TEST_F(AdaptiveDomainTest, AVoxelSizeSetsAllFramesRight) {
    VolumeDesc small = write("data_0001.vdb", {20, 20, 24});
    VolumeDesc large = write("data_0007.vdb", {40, 30, 22});
    VolumeSequenceCheck unsized;
    unsized.take(small);
    EXPECT_NE(test::message_of<InputError>([&] { unsized.take(large); }).find("Adaptive Domain"),
              std::string::npos);
    VolumeSequenceCheck check;
    for (VolumeDesc* frame : {&small, &large}) {
        frame->voxel_size = 0.05;
        EXPECT_NO_THROW(check.take(*frame));
        const LoadedVolume volume = load(*frame);
        EXPECT_TRUE(volume.warnings.empty());
        // Eight voxels, from the fifth on, of Blender's cells; its z is up.
        const Bounds& bounds = volume.reports[0].bounds;
        EXPECT_NEAR(bounds.min.y, 4 * 0.05, 1e-9);
        EXPECT_NEAR(bounds.max.y, 12 * 0.05, 1e-9);
    }
}

// Blender's frame, with what it noted beside it: the smoke lies about its source.
TEST_F(AdaptiveDomainTest, TheCachesConfigurationSetsItRight) {
    std::filesystem::create_directories(dir_ / "data");
    std::filesystem::create_directories(dir_ / "config");
    std::ofstream(dir_ / "config/config_0002.uni", std::ios::binary) << test::blender_config();
    VolumeDesc desc = write("data/fluid_data_0002.vdb", {19, 19, 19}, {{5, 5, 6}, {14, 14, 14}, 1});
    const auto domain = find(desc);
    ASSERT_TRUE(domain && domain->voxel);
    EXPECT_LT(glm::length(*domain->voxel - 0.05), 1e-7);
    const LoadedVolume volume = load(desc);
    EXPECT_TRUE(volume.warnings.empty());
    const Bounds& bounds = volume.reports[0].bounds;
    EXPECT_NEAR(volume.reports[0].metres_per_voxel.x, 0.05, 1e-7);
    // Blender's x, y are the scene's x, -z; relative to the domain's corner. Symmetric in the
    // voxels' steps about the source, which has moved by half of one within the frame.
    EXPECT_NEAR(bounds.center().x - 0.9, 0.6, 0.026);
    EXPECT_NEAR(-bounds.center().z - 1.1, 0.0, 0.026);
    EXPECT_NEAR(bounds.min.x, 25 * 0.05, 1e-6);
    EXPECT_NEAR(bounds.max.x, 35 * 0.05, 1e-6);
    // Another frame, cut elsewhere, goes with it; and what the scene says comes first.
    VolumeSequenceCheck check;
    check.take(desc);
    EXPECT_NO_THROW(check.take(desc));
    desc.voxel_size = 0.1;
    EXPECT_NEAR(load(desc).reports[0].bounds.min.x, 2.5, 1e-9);
    // A configuration of other grids does not count.
    EXPECT_FALSE(find(write("data/fluid_data_0002.vdb", {20, 19, 19})));
}

// Blender draws the grid stretched to the domain's box of 1.4 x 1.2 x 1.7 m.
TEST_F(AdaptiveDomainTest, VoxelsAreStretchedToTheDomainsBox) {
    std::filesystem::create_directories(dir_ / "data");
    std::filesystem::create_directories(dir_ / "config");
    std::ofstream(dir_ / "config/config_0012.uni", std::ios::binary)
        << test::blender_stretched_config();
    test::VdbFixture fixture;
    fixture.boxes = {{{0, 0, 0}, {39, 33, 47}, 1}};
    fixture.blender_metadata = true;
    for (const int finer : {1, 2}) {  // as noise is
        fixture.base_resolution = {40 * finer, 34 * finer, 48 * finer};
        fixture.boxes = {{{0, 0, 0}, {40 * finer - 1, 34 * finer - 1, 48 * finer - 1}, 1}};
        fixture.file_from_index = Affine::scale(Vector3(1.7 / 48 / finer));
        test::write_fixture(dir_ / "data/fluid_data_0012.vdb", {fixture}, "");
        VolumeDesc desc;
        desc.file = dir_ / "data/fluid_data_0012.vdb";
        desc.where = test::k_where;
        desc.grids.resize(1);
        desc.grids[0].grid = "density";
        const LoadedVolume volume = load(desc);
        EXPECT_TRUE(volume.warnings.empty());
        const Bounds& bounds = volume.reports[0].bounds;
        EXPECT_LT(distance(bounds.min, Point3{0, 0, -1.2}), 1e-6);
        EXPECT_LT(distance(bounds.max, Point3{1.4, 1.7, 0}), 1e-6);
        // The file of a domain whose parent is scaled by 1.7 states the size without the parent.
        fixture.file_from_index = Affine::scale(Vector3(1.0 / 48 / finer));
        test::write_fixture(desc.file, {fixture}, "");
        EXPECT_NEAR(load(desc).reports[0].metres_per_voxel.y, 1.2 / 34 / finer, 1e-6);
    }
}

TEST_F(AdaptiveDomainTest, AVoxelSizeIsForCubes) {
    VolumeDesc desc = write("data_0001.vdb", {20, 20, 24});
    test::VdbFixture flat = test::single_voxel("density");
    flat.file_from_index = Affine::scale({0.1, 0.1, 0.2});
    test::write_fixture(desc.file, {flat});
    desc.voxel_size = 0.05;
    EXPECT_NE(test::message_of<InputError>([&] { load(desc); }).find("for voxels that are cubes"),
              std::string::npos);
}

// Baked with 48 divisions of 2.4 m: the true voxel is 0.05 m, and the files say 0.1, 0.08, 0.06.
TEST_F(AdaptiveDomainTest, BlendersOwnFramesAgreeOnTheDomain) {
    const char* const samples = std::getenv("UWVDB_SAMPLES");
    if (samples == nullptr) GTEST_SKIP() << "UWVDB_SAMPLES is not set";
    for (const char* frame : {"0005", "0012", "0020"}) {
        VolumeDesc desc;
        desc.file = std::filesystem::path(samples) / "blender_adaptive_domain" /
                    (std::string("fluid_data_") + frame + ".vdb");
        desc.where = test::k_where;
        desc.grids.resize(1);
        desc.grids[0].grid = "density";
        const auto domain = find(desc);
        ASSERT_TRUE(domain) << frame;
        EXPECT_NEAR(domain->longest_side, 48 * 0.05, 1e-6);
        EXPECT_LE(domain->max_voxels, 48);
        desc.voxel_size = 0.05;
        EXPECT_NEAR(load(desc).reports[0].metres_per_voxel.x, 0.05, 1e-12);
    }
}

}  // namespace
}  // namespace uw
