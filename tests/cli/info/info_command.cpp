// ctest labels: unit
#include "cli/info/info_command.h"

//
// `uwvdb info`: what it says of files and scenes, and that what it hands out renders.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

using ParsedJson = nlohmann::json;

const std::string k_plume =
    std::string(UWVDB_SOURCE_DIR) + "/assets/grids/plume128_blosc_half_0030.vdb";

class Info : public test::CliTest {
  protected:
    ParsedJson json_of(const std::vector<std::string>& arguments) const {
        std::vector<std::string> all{"info", "--json"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const test::ProgramResult result = run(all);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return ParsedJson::parse(result.out);
    }
    static bool warns(const ParsedJson& json, const std::string& part) {
        return std::ranges::any_of(json.at("warnings"), [&](const ParsedJson& line) {
            return line.get<std::string>().find(part) != std::string::npos;
        });
    }
};

TEST_F(Info, TellsOfEveryGridOfAFile) {
    const ParsedJson json = json_of({k_plume});
    EXPECT_EQ(json.at("format"), "vdb");
    EXPECT_EQ(json.at("version"), 224);
    EXPECT_TRUE(json.at("creator").is_null());
    ASSERT_EQ(json.at("grids").size(), 8U);
    for (const ParsedJson& grid : json.at("grids")) {
        for (const char* key : {"type", "class", "precision", "compression", "transform",
                                "metres_per_voxel", "active_voxels", "world_bounds", "values"})
            EXPECT_TRUE(grid.contains(key)) << key;
        EXPECT_TRUE(grid.at("unread").is_null());
        if (grid.at("name") != "density") continue;
        EXPECT_EQ(grid.at("active_voxels"), 18076);
        EXPECT_NEAR(grid.at("metres_per_voxel")[0].get<double>(), 0.046875, 1e-6);
        std::int64_t in_bins = 0;
        for (const ParsedJson& count : grid.at("values").at("histogram").at("counts"))
            in_bins += count.get<std::int64_t>();
        EXPECT_EQ(in_bins, 18076);
    }
    EXPECT_EQ(json.at("advice").at("map"), ParsedJson({"density"}));
    EXPECT_EQ(json.at("advice").at("up"), "z");
    EXPECT_EQ(json.at("advice").at("centering"), "cell");
    EXPECT_GT(json.at("advice").at("contrast").get<double>(), 0.3);
    EXPECT_EQ(json.at("advice").at("lamps").size(), 2U);
}

TEST_F(Info, TellsHowASceneIsRendered) {
    const auto text = [this](const std::vector<std::string>& more) {
        std::vector<std::string> all{"info", "scene.yaml"};
        all.insert(all.end(), more.begin(), more.end());
        const test::ProgramResult result = run(all);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.out;
    };
    EXPECT_NE(text({}).find("integrator volume, quality final: light scattered once or"),
              std::string::npos);
    EXPECT_NE(text({"--set", "render.scattering=multiple"}).find("quality final: all light; what"),
              std::string::npos);
    EXPECT_NE(text({"--set", "render.integrator=path", "--set", "render.samples=7"})
                  .find("all light, by 7 random paths per pixel"),
              std::string::npos);
    const ParsedJson json = json_of(
        {"scene.yaml", "--set", "render.scattering=multiple", "--set", "water.absorption=50"});
    EXPECT_EQ(json.at("render").at("integrator"), "volume");
    EXPECT_EQ(json.at("render").at("scattering"), "multiple");
    EXPECT_TRUE(warns(json, "the nearest lamp lies behind an optical depth"));
    EXPECT_FALSE(warns(json_of({"scene.yaml", "--set", "water.absorption=50"}), "nearest lamp"));
}

TEST_F(Info, CountsWhatIsBadInValues) {
    test::VdbFixture fixture;
    fixture.name = "smoke";
    fixture.max = {9, 0, 0};
    fixture.value = [](int i, int, int) {
        if (i < 2) return std::nan("");
        if (i == 2) return std::numeric_limits<double>::infinity();
        return i < 6 ? -1.0 : 2.0;
    };
    test::VdbFixture empty;
    empty.name = "flame";
    test::write_fixture(folder_ / "a.vdb", {fixture, empty});
    const std::string text = run({"info", "a.vdb"}).out;
    EXPECT_NE(text.find("'smoke' has 2 NaN"), std::string::npos) << text;
    EXPECT_NE(text.find("'flame' is empty"), std::string::npos) << text;
    EXPECT_NE(text.find("a voxel is exactly 1 m"), std::string::npos) << text;
    fixture.name = "shadow";  // which is not to be mapped: its numbers come without drafts
    test::write_fixture(folder_ / "a.vdb", {fixture, empty});
    const ParsedJson grids = json_of({"a.vdb"}).at("grids");
    const ParsedJson& values = grids[grids[1].at("name") == "shadow" ? 1 : 0].at("values");
    EXPECT_EQ(values.at("nan"), 2);
    EXPECT_EQ(values.at("infinite"), 1);
    EXPECT_EQ(values.at("negative"), 3);
}

TEST_F(Info, WhatHasNoFiniteValueHasNoRange) {
    test::VdbFixture fixture;
    fixture.max = {3, 3, 3};
    fixture.value = [](int, int, int) { return std::numeric_limits<double>::infinity(); };
    test::write_fixture(folder_ / "inf.vdb", {fixture});
    const ParsedJson values = json_of({"inf.vdb"}).at("grids")[0].at("values");
    EXPECT_EQ(values.at("infinite"), 64);
    for (const char* key : {"min", "mean", "max"}) EXPECT_TRUE(values.at(key).is_null()) << key;
    EXPECT_TRUE(values.at("histogram").at("from").is_null());
}

TEST_F(Info, NamesPointersForWhatTheyAre) {
    const std::string lfs =
        "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2146\nsize 12345\n";
    write("lfs.vdb", lfs);
    expect_failure({"info", "lfs.vdb"}, 3, "is a Git LFS pointer");
    write("annex.vdb", "/annex/objects/SHA256E-s30--abc.vdb\n");
    expect_failure({"info", "annex.vdb"}, 3, "is a git-annex pointer");
    std::filesystem::create_symlink("../.git/annex/objects/Xk/SHA256E-s30--abc.vdb",
                                    folder_ / "link.vdb");
    expect_failure({"info", "link.vdb"}, 4, "is a git-annex pointer");
    write("link.yaml",
          std::string("uwvdb: 1\ncamera: {resolution: [8, 8], intrinsics: {fov_x: 50}, "
                      "pose: {look_at: [0, 0, 1]}}\nvolumes: [{file: link.vdb, grids: "
                      "{density: {small: 1}}}]\n"));
    expect_failure({"info", "link.yaml"}, 3, "is a git-annex pointer");
}

TEST_F(Info, OptionsThatDoNotGoTogetherAreRefused) {
    expect_failure({"info", k_plume, "--scene", "--json"}, 2, "--scene and --json");
    expect_failure({"info", k_plume, "--picture", "a.jpg"}, 2, "does not end in .png");
    expect_failure({"info", k_plume, "--picture", "scene.yaml/a.png"}, 4, "not a folder");
    expect_failure({"info", "scene.yaml", "--scene"}, 2, "--scene: is for volumes");
    expect_failure({"info", "scene.yaml", "--picture", "a.png"}, 2, "--picture: is for volumes");
    EXPECT_EQ(file_count(), 1U);
}

TEST_F(Info, NamesTheMissingFramesOfASequence) {
    test::VdbFixture fixture;
    fixture.name = "shadow";  // which is not to be mapped: this is about names
    fixture.boxes = {{{0, 0, 0}, {3, 3, 3}, 1}};
    for (const char* frame : {"0003", "0004", "0007"})
        test::write_fixture(folder_ / (std::string("p_") + frame + ".vdb"), {fixture});
    const ParsedJson json = json_of({"p_####.vdb"});
    EXPECT_EQ(json.at("sequence").at("found"), ParsedJson({3, 4, 7}));
    EXPECT_EQ(json.at("sequence").at("missing"), ParsedJson({5, 6}));
    EXPECT_EQ(json.at("sequence").at("frame"), 3);
    EXPECT_EQ(json_of({"p_%04d.vdb", "--frame", "7"}).at("sequence").at("frame"), 7);
    expect_failure({"info", "p_####.vdb", "--frame", "5"}, 4, "p_0005.vdb: no such file");
    expect_failure({"info", "q_####.vdb"}, 4, "no file of this sequence exists");
    expect_failure({"info", k_plume, "--frame", "5"}, 2, "--frame");
}

TEST_F(Info, RefusesHostileFilesInOneLine) {
    write("text.vdb", "this is no volume");
    expect_failure({"info", "text.vdb"}, 3, "is not a VDB file");
    expect_failure({"info", "none.vdb"}, 4, "no such file");
    expect_failure({"info", "."}, 4, "");
    std::ifstream in(k_plume, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    write("cut.vdb", bytes.substr(0, 900));
    expect_failure({"info", "cut.vdb"}, 3, "truncated or damaged");
    // The last grids of the file are lost, the first ones can still be read or are told of.
    write("half.vdb", bytes.substr(0, bytes.size() / 2));
    const test::ProgramResult result = run({"info", "half.vdb"});
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 3) << result.err;
}

TEST_F(Info, SurveysAScene) {
    write("plume.yaml", std::string(R"(uwvdb: 1
camera: {resolution: [64, 36], intrinsics: {fov_x: 60}, pose: {position: [2.1, 0.5, 2], look_at: [2.1, 0.5, -1.5]}}
volumes: [{file: ')") + k_plume +
                            R"(', grids: {density: {small: 0.4, large: 2}}}]
geometry: [{type: plane, point: [0, 0, -4], normal: [0, 0, 1]}]
lamps: [{name: left, position: [0.5, 0.2, 0], intensity: 50}]
)");
    const ParsedJson json = json_of({"plume.yaml"});
    for (const char* key : {"water", "camera", "lamps", "geometry", "grids", "central_ray", "view",
                            "reach", "warnings", "sequences"})
        EXPECT_TRUE(json.contains(key)) << key;
    const ParsedJson& grid = json.at("grids").at(0);
    EXPECT_GT(grid.at("in_view").get<double>(), 0.9);
    EXPECT_GT(grid.at("in_reach").get<double>(), 0.99);
    EXPECT_EQ(json.at("central_ray").at("surface_distance"), 6.0);
    // 1 m of this water times 6, since all of it is the same.
    EXPECT_NEAR(json.at("central_ray").at("optical_depth_water")[1].get<double>(),
                6 * json.at("water").at("c")[1].get<double>(), 1e-9);
    EXPECT_GT(json.at("central_ray").at("optical_depth_volumes")[1].get<double>(), 0.1);
    EXPECT_EQ(json.at("view").at("on_surface"), 1.0);
    EXPECT_EQ(json.at("warnings").size(), 1U) << json.at("warnings");
    EXPECT_TRUE(warns(json, "single scattering leaves out about"));
    EXPECT_GT(json.at("render").at("light_left_out").get<double>(), 0.05);

    EXPECT_TRUE(warns(json_of({"plume.yaml", "--set", "volumes[0].transform.translate=[0,0,20]"}),
                      "nothing of it is in view"));
    EXPECT_TRUE(warns(json_of({"plume.yaml", "--set", "lamps.left.position=[0,0,-500]"}),
                      "no lamp reaches any of it"));
    EXPECT_TRUE(warns(json_of({"plume.yaml", "--set", "volumes[0].grids.density={large: 1e-6}"}),
                      "it will be invisible"));
    EXPECT_TRUE(warns(json_of({"plume.yaml", "--set", "volumes[0].grids.density={large: 1e4}"}),
                      "it is opaque"));
    EXPECT_TRUE(warns(json_of({"plume.yaml", "--set", "water.absorption=3"}), "none will be seen"));
}

// Judged by a draft without the volumes, in which there is no light of theirs either.
TEST_F(Info, SurveysAVolumeThatGivesOffLight) {
    write("fire.yaml", std::string(R"(uwvdb: 1
camera: {resolution: [64, 36], intrinsics: {fov_x: 60}, pose: {position: [2.1, 0.5, 2], look_at: [2.1, 0.5, -1.5]}}
volumes: [{file: ')") + k_plume +
                           R"(', emission: {density: [5, 5, 5]}}]
geometry: [{type: plane, point: [0, 0, -4], normal: [0, 0, 1]}]
)");
    const ParsedJson alone = json_of({"fire.yaml"});
    EXPECT_EQ(alone.at("lamps").size(), 1U);
    EXPECT_FALSE(warns(alone, "the volumes change the picture"));
    // Next to a faint lamp it is plain to see.
    EXPECT_FALSE(warns(json_of({"fire.yaml", "--set",
                                "lamps=[{name: faint, position: [0, 0, 0], intensity: 0.01}]"}),
                       "the volumes change the picture"));
    // A file that cannot be read is named as that of any volume.
    write("fire.vdb", "");
    expect_failure({"info", "fire.yaml", "--set", "volumes[0].file=fire.vdb"}, 3,
                   "is not a VDB file");
}

TEST_F(Info, AWholeSceneNamesItsFileFromTheFolderItIsPrintedTo) {
    test::VdbFixture smoke;
    smoke.boxes = {{{0, 0, 0}, {19, 19, 19}, 1}};
    smoke.file_from_index = Affine::scale(Vector3(0.05));
    test::write_fixture(folder_ / "smoke.vdb", {smoke});
    std::filesystem::create_directory(folder_ / "sub");
    const auto print_to = [&](const std::string& file) {
        const std::string command = "cd '" + folder_.path().string() +
                                    "' && '" UWVDB_PROGRAM "' info smoke.vdb --scene > " + file;
        EXPECT_EQ(std::system(command.c_str()), 0) << command;
        return read(file);
    };
    EXPECT_NE(print_to("sub/smoke.yaml").find("- file: '../smoke.vdb'"), std::string::npos)
        << read("sub/smoke.yaml");
    const test::ProgramResult info =
        run({"info", "sub/smoke.yaml", "--set", "render.scattering=single"});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_NE(print_to("smoke.yaml").find("- file: 'smoke.vdb'"), std::string::npos);
    // Elsewhere it may be copied from: "File names are relative to this scene".
    EXPECT_NE(print_to("sub/smoke.txt").find("- file: 'smoke.vdb'"), std::string::npos);
}

TEST_F(Info, TellsWhatHidesAVolumeAndHowLittleIsInView) {
    test::VdbFixture smoke;
    smoke.boxes = {{{-10, -10, -10}, {9, 9, 9}, 1}};
    smoke.file_from_index = Affine::scale(Vector3(0.1));
    test::write_fixture(folder_ / "smoke.vdb", {smoke});
    write("box.yaml", R"(uwvdb: 1
camera: {resolution: [64, 64], intrinsics: {fov_x: 60}, pose: {position: [0, 0, -6], look_at: [0, 0, 0]}}
volumes: [{file: smoke.vdb, centering: cell, grids: {density: {large: 1}}}]
geometry: [{type: plane, point: [0, 0, 9], normal: [0, 0, -1]}, {type: box, min: [-1.1, -1.1, -1.1], max: [1.1, 1.1, 1.1]}]
lamps: [{position: [0, 0, 0], intensity: 1}]
)");
    const ParsedJson hidden = json_of({"box.yaml"});
    const ParsedJson& grid = hidden.at("grids").at(0);
    EXPECT_EQ(grid.at("in_view"), 0);
    EXPECT_NEAR(grid.at("hidden").get<double>(), 1, 1e-9);
    EXPECT_NE(grid.at("hidden_behind").get<std::string>().find("geometry[1]"), std::string::npos);
    EXPECT_TRUE(warns(hidden, "hidden behind "));
    EXPECT_FALSE(warns(hidden, "nothing of it is in view"));
    const ParsedJson open = json_of({"box.yaml", "--set", "geometry=[]"});
    EXPECT_TRUE(open.at("grids").at(0).at("hidden_behind").is_null());
    EXPECT_FALSE(warns(open, "hidden behind "));
    // The rays leave the volume just behind its corner at (1, 1, -1), so that a few of the 32^3
    // points at which it is looked at are in view.
    const ParsedJson corner = json_of({"box.yaml", "--set", "geometry=[]", "--set",
                                       "camera.pose={position: [0, 0, -6], look_at: [1, 1, -1]}",
                                       "--set", "camera.intrinsics={fx: 1400}"});
    EXPECT_GT(corner.at("grids").at(0).at("in_view").get<double>(), 0);
    EXPECT_TRUE(warns(corner, "of it is in view of the camera")) << corner.at("warnings");
}

TEST_F(Info, AHalfInViewIsAHalf) {
    test::VdbFixture fixture;
    fixture.min = {-16, -4, -4};
    fixture.max = {15, 3, 3};
    fixture.value = [](int, int, int) { return 1.0; };
    fixture.file_from_index = Affine::scale(Vector3(0.1));
    test::write_fixture(folder_ / "bar.vdb", {fixture});
    // The camera looks along z; the plane x = 0 passes through its left edge.
    write("bar.yaml", R"(uwvdb: 1
camera: {resolution: [64, 64], intrinsics: {fx: 32, cx: 0, cy: 32}, pose: {position: [0, 0, -6], look_at: [0, 0, 0], up: [0, -1, 0]}}
volumes: [{file: bar.vdb, centering: cell, grids: {density: {large: 1}}}]
lamps: [{position: [0, 0, 0], profile: {type: spot, beam: 90, edge: 0}, intensity: 1}]
)");
    const ParsedJson grid = json_of({"bar.yaml"}).at("grids").at(0);
    EXPECT_NEAR(grid.at("in_view").get<double>(), 0.5, 0.02);
}

}  // namespace
}  // namespace uw
