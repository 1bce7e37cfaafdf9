// ctest labels: metamorphic
// Textures in formats that a module reads, from the file to the image; and without the module.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/cli_test.h"
#include "tests/support/image_file.h"

namespace uw::test {
namespace {

class OtherTextures : public CliTest {
  protected:
    OtherTextures() {
        write("wall.obj",
              "mtllib wall.mtl\nv -2 -2 2\nv 2 -2 2\nv 2 2 2\nv -2 2 2\n"
              "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl picture\nf 1/1 2/2 3/3 4/4\n");
        write("scene.yaml",
              "uwvdb: 1\ncamera: {resolution: [16, 12], intrinsics: {fov_x: 60}}\n"
              "water: {preset: jerlov-IB}\ngeometry: [{file: wall.obj}]\n"
              "lamps: [{name: lamp, position: [0.3, 0, 0], intensity: [50, 50, 50]}]\n");
    }

    void hang(const std::string& ending) const {
        std::vector<int> values;
        for (int i = 0; i < 8 * 6 * 3; ++i) values.push_back(i * 37 % 251);
        write("picture." + ending, encoded_image(ending, 8, 6, 3, values));
        write("wall.mtl", "newmtl picture\nKd 1 1 1\nmap_Kd picture." + ending + "\n");
    }
};

TEST_F(OtherTextures, GiveTheImageOfTheSamePng) {
    hang("png");
    const ImageFile truth = render();
    for (const std::string ending : {"tif", "tga", "bmp"}) {
        hang(ending);
        const ImageFile image = render();
        ASSERT_EQ(image.names, truth.names);
        // The readers scale whole numbers to 0..1 with the rounding of one 32-bit product or ratio.
        for (const std::string& name : image.names)
            for (std::size_t i = 0; i < truth.channels.at(name).size(); ++i)
                ASSERT_NEAR(image.channels.at(name)[i], truth.channels.at(name)[i],
                            1e-6 * std::abs(truth.channels.at(name)[i]))
                    << ending << " " << name;
    }
}

TEST_F(OtherTextures, AreReadByAProgramThatIsFoundAlongPath) {
    hang("bmp");
    const std::filesystem::path program = UWVDB_PROGRAM;
    const ProgramResult result =
        run_program({"PATH=" + program.parent_path().string(), program.filename().string(),
                     "render", "scene.yaml", "-o", "out.exr"},
                    {.folder = folder_.path(), .program = "/usr/bin/env"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(exists("out.exr"));
}

// OpenEXR is the program's own: it needs no module, for textures as for skies.
TEST_F(OtherTextures, InOpenExrNeedNoModule) {
    std::filesystem::copy_file(UWVDB_PROGRAM, folder_ / "alone");
    const auto render_alone = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render",  "scene.yaml", "-o", "out.exr",
                                           "--quiet", "--layers",   "all"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(arguments, {.folder = folder_.path(), .program = folder_ / "alone"});
    };
    hang("exr");
    const ImageFile truth = render();
    const ProgramResult textured = render_alone({});
    ASSERT_EQ(textured.exit_code, 0) << textured.err;
    EXPECT_EQ(read_exr(folder_ / "out.exr").channels.at("R"), truth.channels.at("R"));

    const std::string surface = "water.surface={height: 3, n: 1.34}";
    write("sky.exr", encoded_image("exr", 8, 4, 3, std::vector<int>(96, 200)));
    const ProgramResult lit =
        render_alone({"--set", surface, "--set", "sky={model: panorama, file: sky.exr}"});
    EXPECT_EQ(lit.exit_code, 0) << lit.err;
}

// Skies are brighter than white, and in proportion: what is made for the eye is no panorama.
TEST_F(OtherTextures, MadeForTheEyeAreNoSkies) {
    hang("png");
    for (const std::string ending : {"png", "jpg"}) {
        write("sky." + ending, encoded_image(ending, 8, 4, 3, std::vector<int>(96, 200)));
        const ProgramResult result = run({"render", "scene.yaml", "-o", "out.exr", "--set",
                                          "water.surface={height: 3, n: 1.34}", "--set",
                                          "sky={model: panorama, file: sky." + ending + "}"});
        EXPECT_EQ(result.exit_code, 3) << result.err;
        EXPECT_NE(result.err.find("sky." + ending + ": not an image of linear"), std::string::npos)
            << result.err;
        EXPECT_NE(result.err.find("hold nothing above white"), std::string::npos);
        EXPECT_NE(result.err.find("convert what it was made from to .exr or .hdr"),
                  std::string::npos);
        EXPECT_EQ(line_count(result.err), 1);
    }
}

TEST_F(OtherTextures, AreRefusedWithoutTheModuleThatReadsThem) {
    hang("tif");
    // Its own place tells a program where its modules are.
    std::filesystem::copy_file(UWVDB_PROGRAM, folder_ / "alone");
    const ProgramResult result =
        run_program({"render", "scene.yaml", "-o", "out.exr"},
                    {.folder = folder_.path(), .program = folder_ / "alone"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_NE(result.err.find("picture.tif: TIFF images need OpenImageIO"), std::string::npos)
        << result.err;
    EXPECT_NE(
        result.err.find("run scripts/demo in the repository that this program was built from"),
        std::string::npos);
    EXPECT_NE(result.err.find("or save it as OpenEXR, PNG or JPEG"), std::string::npos);
    EXPECT_EQ(line_count(result.err), 1);
    EXPECT_FALSE(exists("out.exr"));
}

}  // namespace
}  // namespace uw::test
