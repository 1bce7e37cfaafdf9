// ctest labels: unit
#include "cli/render/frame_sequence.h"

#include <gtest/gtest.h>

#include <csignal>

#include "tests/support/cli_test.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

class OutputFiles : public test::CliTest {};

TEST_F(OutputFiles, GoToTheFolderOneIsInUnlessSaidOtherwise) {
    std::filesystem::create_directory(folder_ / "here");
    const test::ProgramResult result = test::run_program(
        {"render", "../scene.yaml", "--size", "8x4"}, {.folder = folder_ / "here"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(exists("here/scene.exr"));
    EXPECT_TRUE(exists("here/scene.png"));
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("wrote scene.exr\nwrote scene.png (preview, R G B x "),
              std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("peak memory"), std::string::npos);
}

TEST_F(OutputFiles, QuietPrintsWarningsOnly) {
    const auto quiet = [this](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render", "scene.yaml", "-o", "out.exr", "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.out, "");
        return result.err;
    };
    EXPECT_EQ(quiet({"--size", "8x4"}), "");
    const std::string warnings = quiet({"--size", "8x4", "--set", "lamps.left.intensity=0"});
    EXPECT_EQ(test::line_count(warnings), 2) << warnings;
    EXPECT_NE(warnings.find("warning: --set lamps.left.intensity=0: "), std::string::npos);
    EXPECT_NE(warnings.find("warning: the image is black"), std::string::npos);
}

TEST_F(OutputFiles, MayHaveNamesThatAreNoText) {
    const test::ProgramResult result = run({"render", "scene.yaml", "-o", "dive\xff.exr", "--size",
                                            "8x4", "--stats", "s.json", "--progress", "json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(exists("dive\xff.exr"));
    // U+FFFD takes the place of a byte that is not UTF-8, which JSON cannot express.
    EXPECT_NE(read("s.json").find("\"output\": \"dive\xEF\xBF\xBD.exr\""), std::string::npos)
        << read("s.json");
}

TEST_F(OutputFiles, AreLookedAtBeforeRendering) {
    // Whoever were to render first would need hours for this.
    const std::vector<std::string> slow{"render",       "scene.yaml", "--size",    "1920x1080",
                                        "--integrator", "reference",  "--samples", "4096"};
    const auto refused = [&](std::vector<std::string> more, int code, const std::string& part) {
        std::vector<std::string> arguments = slow;
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_failure(arguments, code, part);
    };
    refused({"-o", "none/out.exr", "--stats", "scene.yaml/s.json"}, 4,
            "'scene.yaml' is not a folder; choose another folder");
    std::filesystem::create_directories(folder_ / "taken.exr");
    std::filesystem::create_directories(folder_ / "half.png");
    refused({"-o", "taken.exr"}, 4, "it is a folder");
    refused({"-o", "half.exr"}, 4, "half.png: cannot write: it is a folder");
    refused({"-o", "out.exr", "--irradiance-vdb", "scene.yaml/i.vdb"}, 4, "is not a folder");
    EXPECT_FALSE(exists("half.exr"));
    EXPECT_EQ(file_count(), 3U);
}

TEST_F(OutputFiles, NeverReplaceWhatIsStillNeeded) {
    test::VdbFixture smoke;
    smoke.boxes = {{{0, 0, 0}, {7, 7, 7}, 1.0}};
    test::write_fixture(folder_ / "smoke.vdb", {smoke});
    write("volume.yaml", std::string(test::k_small_scene) +
                             "volumes: [{file: smoke.vdb, grids: {density: {large: 1}}}]\n");
    const std::string volume = read("smoke.vdb");
    expect_failure({"render", "volume.yaml", "--irradiance-vdb", "./smoke.vdb"}, 2,
                   "would replace a volume of the scene");
    expect_failure({"render", "volume.yaml", "--stats", "volume.yaml"}, 2,
                   "would replace the scene");
    expect_failure({"render", "volume.yaml", "-o", "a.exr", "--stats",
                    "../" + folder_.path().filename().string() + "/a.exr"},
                   2, "would replace the image");
    expect_failure({"render", "volume.yaml", "-o", "a.exr", "--stats", "a.png"}, 2,
                   "would replace the preview");
    EXPECT_EQ(read("smoke.vdb"), volume);
    EXPECT_EQ(file_count(), 3U);
}

TEST_F(OutputFiles, NeverReplaceATableOrATexture) {
    const std::string table = "angle_deg,phase\n0,3\n60,1\n120,1\n180,1\n";
    write("phase.csv", table);
    write("white.csv", "wavelength_nm,power\n300,1\n900,2\n");
    write("wall.gltf", test::gltf_text({{"images", R"([{"uri":"wall.png"}])"}}));
    write("wall.png", test::four_texel_png());
    const auto refused = [&](const std::string& set, const std::string& file,
                             const std::string& what) {
        const std::string content = read(file);
        expect_failure({"render", "scene.yaml", "--size", "8x4", "--set", set, "--stats", file}, 2,
                       file + ": --stats would replace " + what + "; give another name");
        EXPECT_EQ(read(file), content);
    };
    refused("water.scattering.phase={type: table, file: phase.csv}", "phase.csv",
            "a phase function of the scene");
    refused("render={response: cie, white: {file: white.csv}}", "white.csv",
            "the white light of the scene");
    refused("geometry=[{file: wall.gltf}]", "wall.png",
            "a texture, buffer or material library of a mesh");
    write("hull.obj", "mtllib hull.mtl\nv 0 0 1\nv 1 0 1\nv 0 1 1\nusemtl a\nf 1 2 3\n");
    write("hull.mtl", "newmtl a\nmap_Kd wall.png\n");
    for (const char* file : {"hull.mtl", "wall.png"})
        refused("geometry=[{file: hull.obj}]", file,
                "a texture, buffer or material library of a mesh");
    EXPECT_EQ(file_count(), 7U);
}

TEST_F(OutputFiles, StayAsTheyWereWhenAnInputIsWrong) {
    write("out.exr", "old");
    write("out.png", "old");
    write("broken.obj", "v 1 2\nf 1 2 3\n");
    expect_failure(
        {"render", "scene.yaml", "-o", "out.exr", "--set", "geometry=[{file: broken.obj}]"}, 3,
        "broken.obj");
    EXPECT_EQ(read("out.exr"), "old");
    EXPECT_EQ(read("out.png"), "old");
    EXPECT_EQ(file_count(), 4U);
}

TEST_F(OutputFiles, StayAsTheyWereWhenInterrupted) {
    write("out.exr", "old");
    for (const int signal : {SIGINT, SIGTERM}) {
        test::Program program(
            {"render", "scene.yaml", "-o", "out.exr", "--stats", "stats.json", "--size",
             "1920x1080", "--integrator", "reference", "--set", "lamps.left.intensity=[0, 0, 0]",
             "--layers", "depth", "--samples", "4096"},
            {.folder = folder_.path()});
        program.wait_for("this lamp is dark");  // the last word before it renders, for days
        program.signal(signal);
        const test::ProgramResult result = program.wait();
        EXPECT_EQ(result.exit_code, 130);
        EXPECT_TRUE(result.err.ends_with("uwvdb: interrupted; nothing was written\n"));
        EXPECT_EQ(read("out.exr"), "old");
        EXPECT_EQ(file_count(), 2U);
    }
}

TEST_F(OutputFiles, AreWholeWhoeverListens) {
    render({"--layers", "default"});
    const std::string whole = read("out.exr");
    for (const test::ProgramOptions& deaf :
         {test::ProgramOptions{.folder = folder_.path(), .streams_full = true},
          test::ProgramOptions{.folder = folder_.path(), .streams_closed = true}}) {
        std::filesystem::remove(folder_ / "out.exr");
        EXPECT_EQ(test::run_program({"render", "scene.yaml", "-o", "out.exr"}, deaf).exit_code, 0);
        EXPECT_EQ(read("out.exr"), whole);
        EXPECT_EQ(test::run_program({"rendr"}, deaf).exit_code, 2);
    }
    // What was asked for on stdout and did not get there is a failure.
    EXPECT_EQ(test::run_program({"--help"}, {.streams_full = true}).exit_code, 4);
}

TEST_F(OutputFiles, BlackImagesAreNotWithoutAWord) {
    const test::ProgramResult dark = run({"render", "scene.yaml", "--set", "lamps=[]"});
    EXPECT_EQ(dark.exit_code, 0);
    EXPECT_NE(dark.err.find("there are no lamps"), std::string::npos);
    EXPECT_NE(dark.err.find("(preview, black)"), std::string::npos);
    const test::ProgramResult murky =
        run({"render", "scene.yaml", "--set", "water.absorption=1e5"});
    EXPECT_EQ(murky.exit_code, 0);
    EXPECT_NE(murky.err.find("warning: the image is black"), std::string::npos);
    EXPECT_NE(murky.err.find(" (see \"Black\" in docs/troubleshooting.md)\n"), std::string::npos);
}

}  // namespace
}  // namespace uw
