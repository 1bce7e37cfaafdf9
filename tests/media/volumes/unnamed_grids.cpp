// ctest labels: unit
// Grids without a name, which programs write who have but one to write: one syntax names them.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/error.h"
#include "media/volumes/load_volumes.h"
#include "media/volumes/vdb_header.h"
#include "media/volumes/velocity_field.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using Names = std::vector<std::string>;

class UnnamedGrids : public testing::Test {
  protected:
    Names names(const std::filesystem::path& file) const {
        Names found;
        for (const GridSummary& grid : read_vdb_header(file, "test").grids)
            found.push_back(grid.name);
        return found;
    }
    /// That each grid is read by its own name, and holds the value that it was given.
    void expect_read(const std::filesystem::path& file, const std::vector<double>& values) const {
        const Names all = names(file);
        ASSERT_EQ(all.size(), values.size());
        for (std::size_t i = 0; i < all.size(); ++i)
            EXPECT_EQ(test::load(file, all[i]).statistics.max, values[i]) << all[i];
    }
    test::TempDir dir_;
};

TEST_F(UnnamedGrids, AreNumberedInVdbFiles) {
    const auto write = [&](const Names& grids) {
        std::vector<test::VdbFixture> fixtures;
        for (const std::string& name : grids)
            fixtures.push_back(test::single_voxel(name, 1 + static_cast<double>(fixtures.size())));
        test::write_fixture(dir_ / "a.vdb", fixtures);
        return dir_ / "a.vdb";
    };
    EXPECT_EQ(names(write({""})), (Names{"[0]"}));
    expect_read(dir_ / "a.vdb", {1});
    EXPECT_EQ(names(write({"", "density"})), (Names{"[0]", "density"}));
    expect_read(dir_ / "a.vdb", {1, 2});
    EXPECT_EQ(names(write({"", ""})), (Names{"[0]", "[1]"}));
    expect_read(dir_ / "a.vdb", {1, 2});
    EXPECT_EQ(names(write({"density", "", "density"})), (Names{"density[0]", "[0]", "density[1]"}));
    expect_read(dir_ / "a.vdb", {1, 2, 3});
}

TEST_F(UnnamedGrids, AreNumberedInNanoVdbFiles) {
    test::write_nvdb_fixture(dir_ / "a.nvdb", test::single_voxel("", 3), "float");
    EXPECT_EQ(names(dir_ / "a.nvdb"), (Names{"[0]"}));
    expect_read(dir_ / "a.nvdb", {3});
    // A file of two segments, as one is appended to another.
    const std::string bytes = test::file_bytes(dir_ / "a.nvdb");
    test::write_file_bytes(dir_ / "b.nvdb", bytes + bytes);
    EXPECT_EQ(names(dir_ / "b.nvdb"), (Names{"[0]", "[1]"}));
    expect_read(dir_ / "b.nvdb", {3, 3});
}

TEST_F(UnnamedGrids, AreListedSoThatTheyCanBeNamed) {
    test::write_fixture(dir_ / "a.vdb", {test::single_voxel("")});
    test::expect_contains(test::refusal(dir_ / "a.vdb", "density"), "no grid 'density'");
    test::expect_contains(test::refusal(dir_ / "a.vdb", "density"), "[0] (float");
    test::write_fixture(dir_ / "b.vdb", {test::single_voxel(""), test::single_voxel("")});
    test::expect_contains(test::refusal(dir_ / "b.vdb", ""), "write '[0]' for the first");
}

TEST_F(UnnamedGrids, AreVelocitiesLikeAnyOther) {
    MotionDesc motion;
    motion.file = dir_ / "a.vdb";
    motion.where = "test";
    std::vector<test::VdbFixture> three;
    for (int axis = 0; axis < 3; ++axis) three.push_back(test::single_voxel("", axis + 1.0));
    test::write_fixture(motion.file, three);
    motion.grids = {"[0]", "[1]", "[2]"};
    const VelocityField field(motion, Centering::node);
    VelocityField::Sampler sampler(field);
    EXPECT_EQ(sampler({1, 1, 1}), openvdb::Vec3d(1, 2, 3));
    motion.grids = {"vel"};
    test::expect_contains(
        test::message_of<InputError>([&] { VelocityField(motion, Centering::node); }),
        "no grid 'vel'");
}

/// A frame of a volume whose light and velocity are other grids.
class SequenceGrids : public UnnamedGrids {
  protected:
    VolumeDesc frame(const std::string& name, const Names& grids) const {
        std::vector<test::VdbFixture> fixtures;
        for (const std::string& grid : grids) fixtures.push_back(test::single_voxel(grid));
        test::write_fixture(dir_ / name, fixtures);
        VolumeDesc desc;
        desc.file = dir_ / name;
        desc.where = "scene.yaml:3:5: volumes[0]";
        desc.grids.resize(1);
        desc.grids[0].grid = "density";
        desc.grids[0].where = desc.where;
        return desc;
    }
    std::string refusal(const VolumeDesc& desc) const {
        return test::message_of<InputError>([&] { VolumeSequenceCheck().take(desc); });
    }
};

TEST_F(SequenceGrids, OfLightAreNeededInEachFrame) {
    VolumeDesc desc = frame("1.vdb", {"density"});
    desc.emission.resize(1);
    desc.emission[0].grid = "flame";
    desc.emission[0].where = "scene.yaml:5:5: volumes[0].emission.flame";
    test::expect_contains(refusal(desc), "volumes[0].emission.flame: no grid 'flame'");
    test::write_fixture(desc.file, {test::single_voxel("density"), test::single_voxel("flame")});
    EXPECT_NO_THROW(VolumeSequenceCheck().take(desc));
}

TEST_F(SequenceGrids, OfVelocityAreNeededWhereTheShutterIsOpen) {
    VolumeDesc desc = frame("1.vdb", {"density"});
    desc.motion.emplace();
    desc.motion->file = desc.file;
    desc.motion->where = "scene.yaml:5:5: volumes[0].velocity";
    desc.motion->grids = {"vel"};
    EXPECT_NO_THROW(VolumeSequenceCheck().take(desc));  // nothing reads them
    desc.motion->shutter = 0.02;
    test::expect_contains(refusal(desc), "volumes[0].velocity: no grid 'vel'");
    test::write_fixture(dir_ / "vel.vdb", {test::single_voxel("vel")});
    desc.motion->file = dir_ / "vel.vdb";
    EXPECT_NO_THROW(VolumeSequenceCheck().take(desc));
    desc.motion->file = dir_ / "none.vdb";
    EXPECT_THROW(VolumeSequenceCheck().take(desc), IoError);
}

}  // namespace
}  // namespace uw
