// ctest labels: unit slow
#include "cli/info/vdb_advice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/support/temp_dir.h"
#include "tests/support/vdb/fluid_configs.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

class VdbAdviceTest : public testing::Test {
  protected:
    /// A box of 20 voxels along each edge.
    static test::VdbFixture cube(const std::string& name, double voxel = 0.05) {
        test::VdbFixture fixture;
        fixture.name = name;
        fixture.boxes = {{{0, 0, 0}, {19, 19, 19}, 1}};
        fixture.file_from_index = Affine::scale(Vector3(voxel));
        return fixture;
    }
    VdbAdvice advise(const std::vector<test::VdbFixture>& grids) const {
        test::write_fixture(dir_ / "a.vdb", grids);
        return advise_on_vdb(inspect_vdb(dir_ / "a.vdb", "here"), "my plume.vdb");
    }
    static bool says(const VdbAdvice& advice, const std::string& part) {
        return std::ranges::any_of(advice.lines, [&](const std::string& line) {
            return line.find(part) != std::string::npos;
        });
    }
    test::TempDir dir_;
};

using GridNames = std::vector<std::string>;

TEST_F(VdbAdviceTest, MapsTheLikeliest) {
    const VdbAdvice advice = advise({cube("heat"), cube("density"), cube("dye")});
    EXPECT_EQ(advice.map, GridNames{"density"});
    EXPECT_TRUE(says(advice, "Map 'density': the name says density."));
    EXPECT_TRUE(says(advice, "Not a concentration by name: 'heat'."));
    EXPECT_EQ(advise({cube("heat")}).map, GridNames{"heat"});  // for want of another
    const VdbAdvice namesakes = advise({cube("density"), cube("density")});
    EXPECT_EQ(namesakes.map, (GridNames{"density[0]", "density[1]"}));
}

/// The number of pictures does not depend on the file, and whoever waits hears of each.
TEST_F(VdbAdviceTest, WorkIsBoundedAndTold) {
    test::VdbFixture apart = cube("density", 1e-3);
    apart.boxes = {{{0, 0, 0}, {0, 0, 0}, 1}, {{999'999, 0, 0}, {999'999, 0, 0}, 1}};
    test::write_fixture(dir_ / "a.vdb", {apart});
    std::vector<double> told;
    const VdbAdvice advice = advise_on_vdb(inspect_vdb(dir_ / "a.vdb", "here"), "a.vdb",
                                           [&](double done, const std::string& next) {
                                               EXPECT_FALSE(next.empty());
                                               told.push_back(done);
                                           });
    EXPECT_FALSE(advice.map.empty());
    EXPECT_GE(told.size(), 4U);
    EXPECT_LE(told.size(), 34U);  // both waters, all drafts and pictures of each
    EXPECT_TRUE(std::ranges::is_sorted(told));
    EXPECT_GE(told.front(), 0);
    EXPECT_LE(told.back(), 1);
}

TEST_F(VdbAdviceTest, WithoutAConcentrationThereIsNoBlock) {
    const VdbAdvice advice = advise({cube("shadow")});
    EXPECT_TRUE(advice.map.empty());
    EXPECT_EQ(advice.volumes, "");
    EXPECT_TRUE(says(advice, "Nothing to map"));
    test::VdbFixture negative = cube("density");
    negative.boxes[0].value = -1;
    EXPECT_TRUE(says(advise({negative}), "has no value above 0"));
}

TEST_F(VdbAdviceTest, LiquidsAreCalledSo) {
    // A cache of a liquid: distances with a negative inside, whose class says nothing, a background
    // of 0, and no density.
    test::VdbFixture phi = cube("phi");
    phi.grid_class = "";
    phi.boxes.push_back({{5, 5, 5}, {14, 14, 14}, -1});
    const VdbAdvice advice = advise({phi});
    EXPECT_TRUE(advice.map.empty());
    EXPECT_TRUE(says(advice,
                     "this looks like a liquid simulation, whose surface or particles are "
                     "in 'phi'. A surface is geometry: export it as a mesh"));
    test::VdbFixture surface = cube("surface");
    surface.grid_class = "level set";
    EXPECT_TRUE(says(advise({surface}), "looks like a liquid simulation"));
    // Beside smoke there is something to map; distances to no liquid are no liquid.
    EXPECT_FALSE(says(advise({surface, cube("density")}), "liquid"));
    surface.name = "sphere";
    EXPECT_FALSE(says(advise({surface}), "liquid"));
    // A volume fraction of this name is one.
    EXPECT_EQ(advise({cube("phi")}).map, GridNames{"phi"});
    test::write_point_grid(dir_ / "points.vdb");
    EXPECT_TRUE(says(advise_on_vdb(inspect_vdb(dir_ / "points.vdb", "here"), "points.vdb"),
                     "looks like a liquid simulation"));
}

TEST_F(VdbAdviceTest, SizesAreThoseOfWhatIsNotEmpty) {
    // A dense grid of 64 m, all of it active, with 1 m of smoke at one end.
    test::VdbFixture dense = cube("density");
    dense.boxes = {{{0, 0, 0}, {1279, 19, 19}, 0}, {{0, 0, 0}, {19, 19, 19}, 1}};
    const VdbAdvice advice = advise({dense});
    EXPECT_EQ(advice.scale, 1);
    EXPECT_TRUE(says(advice, "Units are plausible: 1 m along its longest side."));
}

TEST_F(VdbAdviceTest, SaysWhatLiesBelowASeaFloor) {
    test::VdbFixture low = cube("density");
    low.file_from_index = Affine(Matrix3(0.05), {0, -0.725, 0});
    const VdbAdvice advice = advise({low});
    // The first node's cell begins half a voxel below it.
    EXPECT_TRUE(says(advice, "Its lowest point lies at y = -0.75 m, below y = 0"));
    EXPECT_TRUE(says(advice, "transform.translate: [0, 0.75, 0]"));
    low.file_from_index = Affine(Matrix3(0.05), {0, 0.025, 0});
    EXPECT_FALSE(says(advise({low}), "Its lowest point"));
}

TEST_F(VdbAdviceTest, TheBlockNamesTheFileAsTheSceneHasIt) {
    const VdbAdvice advice = advise({cube("density")});
    EXPECT_TRUE(advice.volumes.starts_with("volumes:\n  - file: 'my plume.vdb'\n"))
        << advice.volumes;
    EXPECT_NE(advice.volumes.find("      density: {small: "), std::string::npos) << advice.volumes;
    EXPECT_NE(advice.volumes.find("    up: y\n"), std::string::npos) << advice.volumes;
}

TEST_F(VdbAdviceTest, UnitsThatAreUnlikelyGetAScale) {
    EXPECT_EQ(advise({cube("density", 0.05)}).scale, 1);  // 1 m
    const VdbAdvice unset = advise({cube("density", 1)});
    EXPECT_TRUE(says(unset, "a voxel is exactly 1 m"));
    EXPECT_NEAR(unset.scale * 20, 2, 1e-9);
    const VdbAdvice centimetres = advise({cube("density", 5)});  // 100 m
    EXPECT_EQ(centimetres.scale, 0.01);
    EXPECT_TRUE(says(centimetres,
                     "lamps can light under water; if these are centimetres, transform.scale: 0.01 "
                     "makes it 1 m."));
    const VdbAdvice huge = advise({cube("density", 50)});  // 1 km
    EXPECT_TRUE(says(huge, "lamps can light under water; transform.scale: 0.002 makes it 2 m."));
    EXPECT_EQ(advise({cube("density", 0.001)}).scale, 100);  // 2 cm
}

TEST_F(VdbAdviceTest, FarFromTheOriginItIsBroughtThere) {
    test::VdbFixture map = cube("density");
    map.file_from_index = Affine(Matrix3(0.05), {652000.25, 12, 5300000});
    const VdbAdvice advice = advise({map});
    EXPECT_TRUE(says(advice, "from the origin, as if in the coordinates of a map"));
    EXPECT_EQ(advice.translate, Vector3(-652001, -12, -5300000));
    // Node 0 to node 19, each with its cell: the block's bounds are those of the file, moved.
    EXPECT_NEAR(advice.bounds.min.x, 652000.25 - 0.025 - 652001, 1e-6);
    EXPECT_NEAR(advice.bounds.max.x - advice.bounds.min.x, 1, 1e-6);
    EXPECT_NE(advice.volumes.find("translate: [-652001, -12, -5300000]"), std::string::npos)
        << advice.volumes;
}

TEST_F(VdbAdviceTest, TheVelocityOfThisMomentIsPreferred) {
    const VdbInspection any = [this] {
        test::write_fixture(dir_ / "v.vdb", {cube("density")});
        return inspect_vdb(dir_ / "v.vdb", "here");
    }();
    const auto with_velocities = [&](const std::vector<std::string>& names) {
        VdbInspection inspection = any;
        for (const std::string& name : names) {
            GridInspection grid;
            grid.summary.name = grid.summary.base_name = name;
            grid.summary.value_type = "vec3s";
            grid.active_voxels = 1;
            inspection.grids.push_back(grid);
        }
        return advise_on_vdb(inspection, "v.vdb");
    };
    EXPECT_TRUE(says(with_velocities({"velocity", "velocity_previous"}), "{grid: velocity}"));
    EXPECT_TRUE(says(with_velocities({"velocity_previous", "velocity"}), "{grid: velocity}"));
    EXPECT_TRUE(says(with_velocities({"vel"}), "{grid: vel}"));
}

TEST_F(VdbAdviceTest, KnowsEmberGenByItsMetadataOrItsFlames) {
    test::VdbFixture temperature = cube("temperature", 1), flames = cube("flames", 1);
    for (test::VdbFixture* grid : {&temperature, &flames}) grid->grid_class = "";
    test::write_fixture(dir_ / "e.vdb", {temperature, flames}, "");
    const VdbAdvice by_name = advise_on_vdb(inspect_vdb(dir_ / "e.vdb", "here"), "e.vdb");
    EXPECT_TRUE(says(by_name, "written by EmberGen"));
    EXPECT_TRUE(says(by_name, "It has no density"));
    EXPECT_TRUE(says(by_name, "a voxel is exactly 1 m"));
    EXPECT_NE(by_name.volumes.find("up: z"), std::string::npos) << by_name.volumes;
    test::VdbFixture density = cube("density", 1);
    density.metadata = {{"embergen_version", "0.5.5.2"}};
    test::write_fixture(dir_ / "m.vdb", {density}, "");
    const VdbAdvice by_mark = advise_on_vdb(inspect_vdb(dir_ / "m.vdb", "here"), "m.vdb");
    EXPECT_TRUE(says(by_mark, "written by EmberGen"));
    EXPECT_FALSE(says(by_mark, "It has no density"));
    // Blender's grid is 'flame', and its files have no creator either.
    EXPECT_FALSE(says(advise({cube("density"), cube("flame")}), "EmberGen"));
}

TEST_F(VdbAdviceTest, KnowsEveryHoudini) {
    for (const char* creator :
         {"Houdini/SOP_OpenVDB_Write", "Houdini 20.5.332/GEO_VDBTranslator"}) {
        test::write_fixture(dir_ / "h.vdb", {cube("density")}, creator);
        EXPECT_TRUE(
            says(advise_on_vdb(inspect_vdb(dir_ / "h.vdb", "here"), "h.vdb"), "written by Houdini"))
            << creator;
    }
}

TEST_F(VdbAdviceTest, LevelSetsAreProposedAsFog) {
    test::write_level_set(dir_ / "s.vdb", true);
    const VdbAdvice advice = advise_on_vdb(inspect_vdb(dir_ / "s.vdb", "here"), "s.vdb");
    EXPECT_EQ(advice.map, GridNames{"surface"});
    EXPECT_TRUE(says(advice, "Map 'surface' as fog: it is a level set"));
    EXPECT_NE(advice.volumes.find("\n    level_set: fog\n"), std::string::npos);
    EXPECT_NEAR(advice.bounds.max.x, 1, 0.11);  // the fog, not the band outside it
    EXPECT_GT(advice.view.draft.contrast, k_hardly_seen);
}

TEST_F(VdbAdviceTest, TheAxisThatIsUpCanBeSaid) {
    test::VdbFixture tall = cube("density");
    tall.boxes = {{{0, 0, 0}, {9, 9, 39}, 1}};
    test::write_fixture(dir_ / "t.vdb", {tall});
    const VdbAdvice lying = advise_on_vdb(inspect_vdb(dir_ / "t.vdb", "here"), "t.vdb");
    EXPECT_NEAR(lying.bounds.max.z - lying.bounds.min.z, 2, 1e-6);
    EXPECT_TRUE(says(lying, "ask again with --up z"));
    const VdbAdvice upright =
        advise_on_vdb(inspect_vdb(dir_ / "t.vdb", "here", UpAxis::z), "t.vdb");
    EXPECT_NEAR(upright.bounds.max.y - upright.bounds.min.y, 2, 1e-6);
    EXPECT_NE(upright.volumes.find("    up: z\n"), std::string::npos);
    EXPECT_TRUE(says(upright, "But --up says that it is z."));
    EXPECT_GT(upright.view.proposal.eye.z, upright.bounds.max.z);  // the camera follows
}

// The object was turned by 30 degrees about Blender's z; its corner is its middle less half its
// sides.
TEST_F(VdbAdviceTest, TheDomainLiesWhereBlenderHasIt) {
    std::filesystem::create_directories(dir_ / "data");
    std::filesystem::create_directories(dir_ / "config");
    std::ofstream(dir_ / "config/config_0012.uni", std::ios::binary)
        << test::blender_stretched_config();
    test::VdbFixture smoke = cube("density", 1.7 / 48);
    smoke.boxes = {{{0, 0, 0}, {39, 33, 47}, 1}};  // all of the domain
    smoke.blender_metadata = true;
    smoke.base_resolution = {40, 34, 48};
    const std::filesystem::path file = dir_ / "data/fluid_data_0012.vdb";
    test::write_fixture(file, {smoke}, "");
    const VdbAdvice advice = advise_on_vdb(inspect_vdb(file, "here"), "b.vdb");
    EXPECT_TRUE(says(advice, "to fill the domain's box: 0.035 x 0.03529 x 0.03542 m"));
    EXPECT_LT(glm::length(advice.rotate - Vector3(0, 30, 0)), 1e-3);
    EXPECT_LT(distance(advice.bounds.center(), Point3{0.3, 1.1, 0.5}), 1e-4);
    EXPECT_NE(advice.volumes.find("rotate: [0, 30, 0], translate: ["), std::string::npos);
    std::filesystem::remove(dir_ / "config/config_0012.uni");
    const VdbAdvice unknown = advise_on_vdb(inspect_vdb(file, "here"), "b.vdb");
    EXPECT_TRUE(says(unknown, "unless its Dimensions are 1.417 x 1.204 x 1.7 m"));
}

// The corners of smoke in one part of a domain are where the objects' own matrices put them,
// whatever its parents do; the solver, and so the file, knows the scale of the object itself alone.
TEST_F(VdbAdviceTest, ADomainIsWhereItsParentsPutIt) {
    const auto scaled = [](const Vector3& scale) { return Affine::scale(scale); };
    const auto moved = [](const Vector3& degrees, const Vector3& offset) {
        return Affine::translation(offset) * Affine::rotation_xyz_degrees(degrees);
    };
    struct Case {
        const char* what;
        Affine parents;
    };
    const Affine turned = moved({10, -20, 35}, {0.2, -0.3, 0.4});
    const std::array<Case, 8> cases{{
        {"none", Affine()},
        {"turned", turned},
        {"scaled", scaled(Vector3(1.7))},
        {"scaled by axis", scaled({1.5, 0.6, 2})},
        {"turned, and scaled", turned * scaled({1.5, 0.6, 2})},
        {"a chain",
         turned * scaled(Vector3(0.5)) * moved({0, 0, 70}, {1, 0, 0}) * scaled({2, 1, 3})},
        {"mirrored", scaled({1, 1, -1})},
        {"mirrored, and turned", turned * scaled({-1.2, 1, 1.4})},
    }};
    const Vector3 own_scale(0.7, 0.6, 0.85);  // of a cube of 2
    const Affine own = Affine::translation({0.3, -0.5, 1.1}) * Affine::scale(own_scale);
    const std::array<std::int32_t, 3> count{40, 34, 48};
    std::filesystem::create_directories(dir_ / "data");
    std::filesystem::create_directories(dir_ / "config");
    const std::filesystem::path file = dir_ / "data/fluid_data_0012.vdb";
    test::VdbFixture smoke = cube("density", 1.7 / 48);
    smoke.boxes = {{{4, 0, 0}, {11, 16, 11}, 1}};
    smoke.blender_metadata = true;
    smoke.base_resolution = {count[0], count[1], count[2]};
    test::write_fixture(file, {smoke}, "");
    for (const Case& c : cases) {
        const Affine blender_from_object = c.parents * own;
        std::ofstream(dir_ / "config/config_0012.uni", std::ios::binary)
            << test::fluid_config(count, Vector3(-1), Vector3(1), blender_from_object);
        const VdbAdvice advice = advise_on_vdb(inspect_vdb(file, "here"), "b.vdb");
        EXPECT_TRUE(says(advice, "Its domain had its corner at")) << c.what;
        EXPECT_FALSE(says(advice, "does not record")) << c.what;
        EXPECT_FALSE(says(advice, "shears")) << c.what;
        Bounds wanted;
        for (const double x : {4.0, 12.0})
            for (const double y : {0.0, 17.0})
                for (const double z : {0.0, 12.0}) {
                    const Point3 corner{2 * x / count[0] - 1, 2 * y / count[1] - 1,
                                        2 * z / count[2] - 1};
                    const Point3 at = blender_from_object * corner;
                    wanted.extend(Point3{at.x, at.z, -at.y});
                }
        // Degrees to 1e-4 and metres to 1e-6, as the block has them.
        EXPECT_LT(distance(advice.bounds.min, wanted.min), 1e-5) << c.what;
        EXPECT_LT(distance(advice.bounds.max, wanted.max), 1e-5) << c.what;
        EXPECT_EQ(advice.volumes.find("scale: [") != std::string::npos, c.parents.determinant() < 0)
            << c.what;
    }
    // A parent that is scaled by axis shears what is turned in it: that is said.
    std::ofstream(dir_ / "config/config_0012.uni", std::ios::binary)
        << test::fluid_config(count, Vector3(-1), Vector3(1),
                              scaled({1.5, 0.6, 2}) * moved({0, 0, 30}, Vector3(0)) * own);
    const VdbAdvice sheared = advise_on_vdb(inspect_vdb(file, "here"), "b.vdb");
    EXPECT_TRUE(says(sheared, "shears it in Blender"));
    EXPECT_TRUE(says(sheared, "Its domain had its corner at"));
}

}  // namespace
}  // namespace uw
