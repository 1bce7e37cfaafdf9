// ctest labels: unit
#include "media/volumes/vdb_header.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using test::expect_contains;
using test::file_bytes;
using test::k_where;
using test::load;
using test::refusal;
using test::single_voxel;
using test::TempDir;
using test::VdbFixture;
using test::VdbNumbers;
using test::write_file_bytes;

TEST(VdbHeaderReader, ListsGridsWithoutReadingThem) {
    const TempDir dir;
    VdbFixture half = single_voxel("density");
    half.numbers = VdbNumbers::half;
    VdbFixture wide = single_voxel("heat");
    wide.numbers = VdbNumbers::float64;
    wide.grid_class = "";
    test::write_fixture(dir / "a.vdb", {half, wide}, "a program");
    const VdbHeader header = read_vdb_header(dir / "a.vdb", k_where);
    EXPECT_EQ(header.creator, "a program");
    EXPECT_EQ(header.version, 224U);
    ASSERT_EQ(header.grids.size(), 2U);
    EXPECT_EQ(header.describe_grids(), "density (half float, fog volume), heat (double, unknown)");
    EXPECT_EQ(header.grids[0].active_voxels, 1);
}

TEST(VdbHeaderReader, RefusesWhatIsNoVdb) {
    const TempDir dir;
    EXPECT_THROW(read_vdb_header(dir / "none.vdb", k_where), IoError);
    EXPECT_THROW(read_vdb_header(dir.path(), k_where), IoError);
    write_file_bytes(dir / "text.vdb", "this is a text, not a volume");
    expect_contains(refusal(dir / "text.vdb", "density"), "is not a VDB file");
    write_file_bytes(dir / "empty.vdb", "");
    expect_contains(refusal(dir / "empty.vdb", "density"), "is not a VDB file");
}

TEST(VdbHeaderReader, NamesTheVersionOfAFileThatIsTooNew) {
    const TempDir dir;
    test::write_fixture(dir / "a.vdb", {single_voxel("density")});
    std::string bytes = file_bytes(dir / "a.vdb");
    bytes[8] = static_cast<char>(225);  // the format's version follows 8 bytes of magic number
    bytes[12] = 13;
    write_file_bytes(dir / "new.vdb", bytes);
    const std::string message = refusal(dir / "new.vdb", "density");
    expect_contains(message, "version 225, written by OpenVDB 13.");
    expect_contains(message, "up to version 224");
}

TEST(VdbHeaderReader, ForgedSizesAreNotBelieved) {
    const TempDir dir;
    test::write_fixture(dir / "a.vdb", {single_voxel("density")});
    const std::string bytes = file_bytes(dir / "a.vdb");
    // Words all over the header and metadata claim in turn to be 4 GB.
    for (std::size_t at = 21; at < std::min<std::size_t>(bytes.size() - 4, 700); at += 3) {
        std::string forged = bytes;
        for (std::size_t i = 0; i < 4; ++i) forged[at + i] = static_cast<char>(0xfe);
        write_file_bytes(dir / "forged.vdb", forged);
        try {
            load(dir / "forged.vdb", "density");  // a word that is no size may well load
        } catch (const InputError&) {
        }
    }
}

TEST(VdbHeaderReader, TellsNamesakesApartByNumber) {
    const TempDir dir;
    test::write_fixture(dir / "a.vdb", {single_voxel("density", 1), single_voxel("density", 2)});
    const std::vector<GridSummary> grids = read_vdb_header(dir / "a.vdb", k_where).grids;
    ASSERT_EQ(grids.size(), 2U);
    EXPECT_EQ(grids[0].name, "density[0]");
    EXPECT_EQ(grids[1].name, "density[1]");
    EXPECT_EQ(grids[1].base_name, "density");
}

TEST(VdbHeaderReader, HasTheBoxOfTheActiveVoxels) {
    const TempDir dir;
    VdbFixture fixture = single_voxel("density");
    fixture.min = {-3, 0, 2};
    fixture.max = {7, 9, 11};
    test::write_fixture(dir / "a.vdb", {fixture});
    const GridSummary grid = read_vdb_header(dir / "a.vdb", k_where).grids.at(0);
    ASSERT_TRUE(grid.active_box);
    EXPECT_EQ(grid.active_box->min, (std::array<std::int32_t, 3>{-3, 0, 2}));
    EXPECT_EQ(grid.active_box->max, (std::array<std::int32_t, 3>{7, 9, 11}));
    EXPECT_EQ(grid.active_voxels, 11 * 10 * 10);
}

VdbHeader header_of_grids(const std::vector<std::string>& names) {
    VdbHeader header;
    for (const std::string& name : names) {
        header.grids.emplace_back();
        header.grids.back().name = header.grids.back().base_name = name;
    }
    return header;
}

TEST(VdbHeaderReader, KnowsBlendersCachesByTheirNamesOrTheirMark) {
    EXPECT_TRUE(header_of_grids({"density", "shadow", "velocity"}).from_blender_fluid());
    EXPECT_TRUE(header_of_grids({"density", "density_noise"}).from_blender_fluid());
    EXPECT_FALSE(header_of_grids({"density", "velocity"}).from_blender_fluid());  // anyone's
    EXPECT_FALSE(header_of_grids({"shadow", "salt"}).from_blender_fluid());
    EXPECT_FALSE(VdbHeader().from_blender_fluid());
    VdbHeader marked = header_of_grids({"salt"});
    marked.grids[0].base_resolution = {128, 64, 51};
    EXPECT_TRUE(marked.from_blender_fluid());
    marked.creator = "Houdini";
    EXPECT_FALSE(marked.from_blender_fluid());
}

TEST(VdbHeaderReader, DescribesSomeOfManyGrids) {
    EXPECT_EQ(VdbHeader().describe_grids(), "no grids");
    const std::string many = header_of_grids(std::vector<std::string>(30, "g")).describe_grids();
    EXPECT_TRUE(many.ends_with(" and 6 more")) << many;
}

}  // namespace
}  // namespace uw
