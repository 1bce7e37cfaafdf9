// ctest labels: unit
//
// A program built without OpenImageIO, OpenColorIO, Ceres and OpenCV (scripts/demo --small).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

class SmallBuild : public test::CliTest {
  protected:
    // A build folder in which a program lies where they do, and no modules.
    SmallBuild() {
        std::filesystem::create_directories(program_.parent_path());
        std::filesystem::copy_file(UWVDB_PROGRAM, program_);
        write("build/release/CMakeCache.txt", "");
    }
    test::ProgramResult run_small(const std::vector<std::string>& arguments) const {
        return test::run_program(arguments, {.folder = folder_.path(), .program = program_});
    }

    const std::filesystem::path program_ = folder_ / "build/release/cli/uwvdb";
};

TEST_F(SmallBuild, NamesTheCommandThatBringsWhatItLacks) {
    write("points.csv",
          "image,x,y,z,u,v\na,-0.5,-0.3,0,12.928,7.357\na,0.5,-0.3,0,20.072,7.357\na,0.5,0.3,0,20."
          "072,11.643\n"
          "a,-0.5,0.3,0,12.928,11.643\na,0,0.1,0,16.500,10.214\na,0.2,-0.1,0,17.929,8.786\n");
    write("a.ocio", "");
    struct Case {
        std::string lacks;
        std::vector<std::string> arguments;
    };
    for (const Case& each : std::vector<Case>{
             {"TIFF files need OpenImageIO", {"render", "scene.yaml", "-o", "out.tif"}},
             {"a view needs OpenColorIO",
              {"render", "scene.yaml", "-o", "out.exr", "--set", "render.view={config: a.ocio}"}},
             {"fitting needs Ceres and OpenCV",
              {"fit", "scene.yaml", "--points", "points.csv", "--unknown",
               "camera.intrinsics.fov_x"}}}) {
        const test::ProgramResult result = run_small(each.arguments);
        EXPECT_NE(result.exit_code, 0);
        EXPECT_NE(result.err.find(each.lacks), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("; run scripts/demo, which installs what is missing and builds"),
                  std::string::npos)
            << result.err;
        EXPECT_EQ(test::line_count(result.err), 1) << result.err;
    }
}

// A panorama and a texture in OpenEXR need no module: the pictures are those of the whole program.
TEST_F(SmallBuild, ReadsPanoramasAndTexturesInOpenExr) {
    ASSERT_EQ(run({"render", "scene.yaml", "-o", "sky.exr", "--size", "16x8"}).exit_code, 0);
    write("board.obj",
          "mtllib board.mtl\nusemtl board\nv -2 -2 3\nv 2 -2 3\nv 2 2 3\nv -2 2 3\n"
          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
    write("board.mtl", "newmtl board\nKd 1 1 1\nmap_Kd sky.exr\n");
    const auto rendered = [&](const std::filesystem::path& program, const std::string& out) {
        const test::ProgramResult result = test::run_program(
            {"render", "scene.yaml", "-o", out, "--set", "geometry=[{file: board.obj}]", "--set",
             "water.surface={height: 3, n: 1.34}", "--set", "sky={model: panorama, file: sky.exr}"},
            {.folder = folder_.path(), .program = program});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read(out);
    };
    const std::string small = rendered(program_, "small.exr");
    EXPECT_FALSE(small.empty());
    EXPECT_TRUE(small == rendered(UWVDB_PROGRAM, "whole.exr"));
}

// The program with which scripts/demo renders its picture, before the whole one is built.
TEST_F(SmallBuild, TheFirstPictureIsThatOfTheWholeProgram) {
    const std::filesystem::path first =
        std::filesystem::path(UWVDB_PROGRAM).parent_path() / "uwvdb_picture";
    const std::string scene = UWVDB_SOURCE_DIR "/assets/scenes/plume.yaml";
    const auto rendered = [&](const std::filesystem::path& program, const std::string& name) {
        const test::ProgramResult result =
            test::run_program({"render", scene, "-o", name + ".exr", "--size", "32x18"},
                              {.folder = folder_.path(), .program = program});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read(name + ".exr") + read(name + ".png");
    };
    const std::string picture = rendered(first, "first");
    EXPECT_FALSE(picture.empty());
    EXPECT_TRUE(picture == rendered(UWVDB_PROGRAM, "whole"));
    const test::ProgramResult other =
        test::run_program({"info", scene}, {.folder = folder_.path(), .program = first});
    EXPECT_EQ(other.exit_code, 2) << other.err;
}

}  // namespace
}  // namespace uw
