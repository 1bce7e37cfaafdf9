// ctest labels: unit
#include "media/volumes/vdb_file.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "media/volumes/load_volumes.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using test::expect_contains;
using test::k_where;
using test::load;
using test::refusal;
using test::single_voxel;
using test::TempDir;
using test::VdbFixture;
using test::VdbNumbers;

TEST(VdbFile, RefusesByNameAndListsWhatThereIs) {
    const TempDir dir;
    test::write_point_grid(dir / "points.vdb");
    std::string message = refusal(dir / "points.vdb", "points");
    expect_contains(message, "grid 'points' holds points");
    expect_contains(message, "points (ptdataidx32");
    test::write_vector_grid(dir / "vectors.vdb");
    expect_contains(refusal(dir / "vectors.vdb", "vel"), "grid 'vel' holds vectors (vec3s)");
    test::write_bool_and_int_grids(dir / "ints.vdb");
    expect_contains(refusal(dir / "ints.vdb", "flag"), "values of type bool");
    message = refusal(dir / "ints.vdb", "flags");
    expect_contains(message, "values of type int32");
    expect_contains(message, "flag (bool, unknown), flags (int32, unknown)");
    test::write_frustum_grid(dir / "frustum.vdb");
    expect_contains(refusal(dir / "frustum.vdb", "density"), "frustum");
}

TEST(VdbFile, RefusesLevelSetsWithOrWithoutTheirClass) {
    const TempDir dir;
    test::write_level_set(dir / "class.vdb", true);
    expect_contains(refusal(dir / "class.vdb", "surface"), "grid 'surface' is a level set");
    test::write_level_set(dir / "unknown.vdb", false);
    const std::string message = refusal(dir / "unknown.vdb", "surface");
    expect_contains(message, "is a level set, though its class is 'unknown'");
    expect_contains(message, "surface (float, unknown)");
}

// A sphere of radius 1 m whose narrow band is 0.3 m deep: the fog rises over these to 1.
TEST(VdbFile, LevelSetsBecomeFogOnRequest) {
    const TempDir dir;
    for (const bool with_class : {true, false}) {
        test::write_level_set(dir / "a.vdb", with_class);
        VolumeDesc desc;
        desc.file = dir / "a.vdb";
        desc.where = k_where;
        desc.level_sets = LevelSets::fog;
        desc.grids.resize(1);
        desc.grids[0].grid = "surface";
        const LoadedVolume volume = load_volume(desc, {{GridLoad{0, 1.0}}});
        EXPECT_TRUE(volume.warnings.empty());
        EXPECT_EQ(volume.reports[0].statistics.max, 1);
        for (const double column : volume.reports[0].column) EXPECT_NEAR(column, 1.7, 2e-3);
        VolumeSequenceCheck check;
        EXPECT_NO_THROW(check.take(desc));
    }
    test::write_fixture(dir / "fog.vdb", {single_voxel("density")});
    const VdbHeader header = read_vdb_header(dir / "fog.vdb", k_where);
    expect_contains(test::message_of<InputError>([&] {
                        load_grid(header, "density", k_where, k_default_slab_bytes, LevelSets::fog);
                    }),
                    "is no level set (its class is 'fog volume', its background 0)");
}

TEST(VdbFile, ReadingStops) {
    const TempDir dir;
    test::write_fixture(dir / "a.vdb", {single_voxel("density")});
    const VdbHeader header = read_vdb_header(dir / "a.vdb", k_where);
    std::atomic<bool> stop{true};
    const StopScope scope(stop);
    EXPECT_THROW(load_grid(header, "density", k_where), Interrupted);
    stop = false;
    EXPECT_EQ(load_grid(header, "density", k_where).statistics.max, 1);
}

TEST(VdbFile, MissingAndAmbiguousNames) {
    const TempDir dir;
    test::write_fixture(dir / "a.vdb", {single_voxel("density"), single_voxel("temperature")});
    const std::string message = refusal(dir / "a.vdb", "densty");
    expect_contains(message, "no grid 'densty'; did you mean 'density'?");
    expect_contains(message, "density (float, fog volume), temperature (float, fog volume)");
    EXPECT_EQ(refusal(dir / "a.vdb", "salinity").find("did you mean"), std::string::npos);

    test::write_fixture(dir / "same.vdb", {single_voxel("density", 1), single_voxel("density", 2)});
    expect_contains(refusal(dir / "same.vdb", "density"),
                    "2 grids are called 'density'; write 'density[0]' for the first");
    expect_contains(refusal(dir / "same.vdb", "density[2]"), "no grid 'density[2]'");
    EXPECT_EQ(load(dir / "same.vdb", "density[0]").statistics.max, 1);
    EXPECT_EQ(load(dir / "same.vdb", "density[1]").statistics.max, 2);
}

TEST(VdbFile, ReadsFloatHalfAndDouble) {
    const TempDir dir;
    for (const VdbNumbers numbers : {VdbNumbers::float32, VdbNumbers::half, VdbNumbers::float64}) {
        for (const char* grid_class : {"fog volume", ""}) {
            VdbFixture fixture = single_voxel("density", 0.75);  // exact in 16 bits
            fixture.numbers = numbers;
            fixture.grid_class = grid_class;
            test::write_fixture(dir / "a.vdb", {fixture});
            const LoadedGrid grid = load(dir / "a.vdb", "density");
            ASSERT_EQ(grid.bricks.size(), 1U);
            EXPECT_EQ(grid.bricks[0].sample({1, 1, 1}), 0.75);
            EXPECT_EQ(grid.bricks[0].sample({1.5, 1, 1}), 0.375);
            EXPECT_TRUE(grid.warnings.empty());
        }
    }
}

TEST(VdbFile, BadValuesAreCountedAndZero) {
    const TempDir dir;
    VdbFixture fixture = single_voxel("density");
    fixture.max = {4, 1, 1};
    fixture.value = [](int i, int, int) {
        const std::array<double, 5> values{0, std::nan(""), std::numeric_limits<double>::infinity(),
                                           -3, 2};
        return values[static_cast<std::size_t>(i)];
    };
    test::write_fixture(dir / "a.vdb", {fixture});
    const LoadedGrid grid = load(dir / "a.vdb", "density");
    const GridStatistics& s = grid.statistics;
    EXPECT_EQ(s.active_voxels, 4);
    EXPECT_EQ(s.nan_voxels, 1);
    EXPECT_EQ(s.infinite_voxels, 1);
    EXPECT_EQ(s.negative_voxels, 1);
    EXPECT_EQ(s.min, 0);
    EXPECT_EQ(s.max, 2);
    EXPECT_EQ(s.mean, 0.5);
    ASSERT_EQ(grid.warnings.size(), 3U);
    for (const std::string& warning : grid.warnings) EXPECT_TRUE(warning.starts_with(k_where));
    expect_contains(grid.warnings[0], "1 of 4 active voxels are NaN: treated as 0");
    for (int i = 1; i <= 3; ++i)
        EXPECT_EQ(grid.bricks[0].sample({static_cast<double>(i), 1, 1}), 0) << i;
    EXPECT_EQ(grid.bricks[0].sample({4, 1, 1}), 2);
}

TEST(VdbFile, BackgroundAndInactiveValuesAreZero) {
    const TempDir dir;
    VdbFixture fixture = single_voxel("density", 2);
    fixture.background = 0.5;
    fixture.inactive_boxes = {{{0, 0, 0}, {7, 7, 7}, 9.0}, {{128, 0, 0}, {255, 127, 127}, 9.0}};
    test::write_fixture(dir / "a.vdb", {fixture});
    const LoadedGrid grid = load(dir / "a.vdb", "density");
    ASSERT_EQ(grid.warnings.size(), 1U);
    expect_contains(grid.warnings[0], "background is 0.5");
    ASSERT_EQ(grid.bricks.size(), 1U);
    EXPECT_EQ(grid.bricks[0].sample({1, 1, 1}), 2);
    EXPECT_EQ(grid.bricks[0].sample({2, 1, 1}), 0);
    EXPECT_EQ(grid.bricks[0].sample({150, 50, 50}), 0);
    EXPECT_EQ(grid.statistics.active_voxels, 1);
}

TEST(VdbFile, EmptyGridsWarn) {
    const TempDir dir;
    VdbFixture empty;
    VdbFixture zero;
    zero.name = "zero";
    zero.boxes = {{{0, 0, 0}, {3, 3, 3}, 0.0}};
    test::write_fixture(dir / "a.vdb", {empty, zero});
    for (const char* name : {"density", "zero"}) {
        const LoadedGrid grid = load(dir / "a.vdb", name);
        EXPECT_TRUE(grid.bricks.empty());
        ASSERT_EQ(grid.warnings.size(), 1U);
        expect_contains(grid.warnings[0], "contributes nothing");
    }
}

TEST(VdbFile, ActiveTilesCount) {
    const TempDir dir;
    VdbFixture fixture;
    fixture.boxes = {{{0, 0, 0}, {299, 199, 199}, 3.0}};  // tiles of 128^3 and 8^3, and leaves
    test::write_fixture(dir / "a.vdb", {fixture});
    const LoadedGrid grid = load(dir / "a.vdb", "density");
    EXPECT_EQ(grid.statistics.active_voxels, 300LL * 200 * 200);
    EXPECT_EQ(grid.statistics.mean, 3.0);
    ASSERT_EQ(grid.bricks.size(), 1U);
    EXPECT_EQ(grid.bricks[0].sample({64, 64, 64}), 3.0);
    EXPECT_EQ(grid.bricks[0].sample({127.5, 127.5, 127.5}), 3.0);
    EXPECT_EQ(grid.bricks[0].sample({299.5, 100, 100}), 1.5);
    EXPECT_EQ(grid.bricks[0].sample({-0.5, 100, 100}), 1.5);
    EXPECT_LT(grid.bricks[0].bytes(), std::size_t{20} << 20);
}

TEST(VdbFile, QuantisationStaysWithinItsBound) {
    const TempDir dir;
    VdbFixture fixture = single_voxel("density");
    fixture.min = {0, 0, 0};
    fixture.max = {15, 15, 15};
    fixture.value = [](int i, int j, int k) { return 1e3 + 0.37 * i + std::sin(j + 2.0 * k); };
    test::write_fixture(dir / "a.vdb", {fixture});
    const LoadedGrid grid = load(dir / "a.vdb", "density");
    // The largest range of one block is below 8 * 0.37 + 2; a float near 1000 rounds to 6e-5.
    const double bound = 0.5 * 5.0 / 65535 + 1.3e-4;
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j)
            for (int k = 0; k < 16; ++k)
                EXPECT_NEAR(grid.bricks[0].sample({double(i), double(j), double(k)}),
                            fixture.value(i, j, k), bound);
}

TEST(VdbFile, GridsThatShareATreeAreRead) {
    const TempDir dir;
    test::write_instanced_grids(dir / "a.vdb");
    const LoadedGrid grid = load(dir / "a.vdb", "copy");
    EXPECT_EQ(grid.statistics.max, 2);
    EXPECT_EQ(grid.file_from_index.linear()[0][0], 0.25);
    EXPECT_EQ(load(dir / "a.vdb", "density").file_from_index.linear()[0][0], 1);
}

}  // namespace
}  // namespace uw
