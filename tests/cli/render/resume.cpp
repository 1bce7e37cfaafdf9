// ctest labels: unit
// Which frames --resume leaves out, beyond what frames.cpp looks at.
#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/cli_test.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

class Resume : public test::CliTest {
  protected:
    /// Whether --resume finds frame 2 of scene.yaml there; if not, it renders it.
    bool is_there() const {
        const test::ProgramResult result = run({"render", "scene.yaml", "--frames", "2", "-o",
                                                "{frame}.exr", "--size", "8x6", "--resume"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.err.find("resume: frame 2 is there already") != std::string::npos;
    }
};

TEST_F(Resume, NoticesEveryFileWrittenSince) {
    const std::string table = "angle_deg,phase\n0,3\n60,1\n120,1\n180,1\n";
    write("water.csv", table);
    write("smoke.csv", table);
    write("white.csv", "wavelength_nm,power\n300,1\n900,2\n");
    write("wall.gltf", test::gltf_text({{"images", R"([{"uri":"wall.png"}])"}}));
    write("wall.png", test::four_texel_png());
    test::VdbFixture smoke;
    smoke.boxes = {{{0, 0, 0}, {7, 7, 7}, 1.0}};
    test::write_fixture(folder_ / "smoke_0002.vdb", {smoke});
    write("scene.yaml", R"(uwvdb: 1
camera: {resolution: [8, 6], intrinsics: {fov_x: 60}}
water:
  absorption: 0.1
  scattering: {b: 0.2, phase: {type: table, file: water.csv}}
volumes:
  - file: smoke_####.vdb
    grids: {density: {scattering: 0.2, phase: {type: table, file: smoke.csv}}}
geometry: [{file: wall.gltf}]
lamps: [{name: lamp, position: [0, 0, -1], intensity: 50}]
render: {samples: 1, response: cie, white: {file: white.csv}}
)");
    EXPECT_FALSE(is_there());
    EXPECT_TRUE(is_there());
    for (const char* name :
         {"water.csv", "smoke.csv", "white.csv", "wall.gltf", "wall.png", "smoke_0002.vdb"}) {
        const std::filesystem::path file = folder_ / name;
        const auto before = std::filesystem::last_write_time(file);
        const auto later = std::filesystem::file_time_type::clock::now() + std::chrono::seconds(5);
        std::filesystem::last_write_time(file, later);
        EXPECT_FALSE(is_there()) << name;
        std::filesystem::last_write_time(file, before);
        EXPECT_TRUE(is_there()) << name;
    }
}

// The header of an image tells of the camera that it was rendered with.
TEST_F(Resume, KnowsImagesOfAGltfCamera) {
    write("scene.yaml",
          "uwvdb: 1\ncamera: {resolution: [8, 6]}\n"
          "water: {absorption: 0.1, scattering: {b: 0.1, phase: {type: water}}}\n"
          "geometry: [{file: '" UWVDB_SOURCE_DIR
          "/assets/meshes/seabed.glb', camera: Camera, lamps: all}]\nrender: {samples: 1}\n");
    EXPECT_FALSE(is_there());
    EXPECT_TRUE(is_there());
}

}  // namespace
}  // namespace uw
