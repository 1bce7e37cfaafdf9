// ctest labels: unit
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

class BadInput : public test::CliTest {
  protected:
    // Renders k_small_scene with a volume of `file` whose `grid` is used.
    void expect_refused(const std::string& file, const std::string& grid,
                        const std::vector<std::string>& parts) const {
        write("volume.yaml", std::string(test::k_small_scene) + "volumes:\n  - file: " + file +
                                 "\n    grids: {" + grid + ": {large: 1}}\n");
        const std::size_t before = file_count();
        for (const std::string& part : parts)
            expect_failure({"render", "volume.yaml", "-o", "out.exr"}, 3, part);
        EXPECT_EQ(file_count(), before);
    }
};

TEST_F(BadInput, SceneErrorsHavePlaceAndMend) {
    write("typo.yaml", std::string(test::k_small_scene) + "rendr: {samples: 1}\n");
    expect_failure({"render", "typo.yaml"}, 3,
                   "uwvdb: typo.yaml:15:1: rendr: unknown key; did you mean 'render'?");
    expect_failure({"render", "scene.yaml", "--set", "lamps.left.intensity=[1, 2]"}, 3,
                   "--set lamps.left.intensity=[1, 2]: lamps[0].intensity: has 2 values");
    write("empty.yaml", "");
    expect_failure({"render", "empty.yaml"}, 3, "empty.yaml:1:1: is empty");
    write("binary.yaml", std::string("\x00\xff\x01", 3));
    expect_failure({"render", "binary.yaml"}, 3, "binary.yaml:1:1: ");
    write("no mesh.yaml", std::string(test::k_small_scene) + "volumes: [{file: none.vdb}]\n");
    expect_failure({"render", "no mesh.yaml"}, 3, "no such file 'none.vdb'");
    EXPECT_FALSE(exists("typo.exr"));
}

TEST_F(BadInput, FilesOfOtherFormatsGivenAsScenes) {
    test::VdbFixture smoke;
    smoke.boxes = {{{0, 0, 0}, {7, 7, 7}, 1.0}};
    test::write_fixture(folder_ / "smoke.vdb", {smoke});
    expect_failure({"render", "smoke.vdb"}, 3,
                   "smoke.vdb: is a VDB volume, not a valid scene; a scene that shows it is "
                   "written by: uwvdb info 'smoke.vdb' --scene > scene.yaml");
    // Larger than any scene may be.
    write("large.vdb", std::string(" BDV\0\0\0\0", 8) + std::string(std::size_t{17} << 20U, 'x'));
    expect_failure({"render", "large.vdb"}, 3, "is a VDB volume");
    write("room.blend", std::string("BLENDER-v300\0\xff", 14));
    expect_failure({"render", "room.blend"}, 3, "is a Blender file, not a valid scene; export");
    write("packed.blend", "\x28\xb5\x2f\xfd packed");
    expect_failure({"validate", "packed.blend"}, 3, "is a Blender file");
    write("room.glb", std::string("glTF\2\0\0\0\xff", 9));
    expect_failure({"render", "room.glb"}, 3,
                   "is a glTF file, not a valid scene; name it in a scene: geometry: [{file: "
                   "room.glb}]");
    write("room.gltf", R"({"asset": {"version": "2.0"}})");
    expect_failure({"render", "room.gltf"}, 3, "is a glTF file");
    render();
    expect_failure({"render", "out.exr"}, 3, "is an OpenEXR image, not a valid scene; name the");
    write("picture.yaml", "\x89PNG\r\n\x1a\n");
    expect_failure({"info", "picture.yaml"}, 3, "is a PNG image");
}

TEST_F(BadInput, ScenesThatCannotBeRead) {
    expect_failure({"render", "missing.yaml"}, 4, "missing.yaml: no such file");
    std::filesystem::create_directory(folder_ / "folder");
    expect_failure({"render", "folder"}, 4, "is a folder");
    expect_failure({"render", "two\nlines.yaml"}, 4, "no such file");
}

TEST_F(BadInput, VolumesSayWhatTheirFileHas) {
    test::VdbFixture smoke;
    smoke.boxes = {{{0, 0, 0}, {7, 7, 7}, 1.0}};
    test::write_fixture(folder_ / "smoke.vdb", {smoke});
    expect_refused("smoke.vdb", "densty",
                   {"volume.yaml:17:21: volumes[0].grids.densty: no grid 'densty'; did you mean "
                    "'density'?",
                    "density (float, fog volume)"});
    test::write_level_set(folder_ / "solid.vdb", true);
    expect_refused("solid.vdb", "surface", {"is a level set", "surface (float, level set)"});
    test::write_point_grid(folder_ / "points.vdb");
    expect_refused("points.vdb", "points", {"holds points"});
    test::write_vector_grid(folder_ / "flow.vdb");
    expect_refused("flow.vdb", "vel", {"holds vectors (vec3s)"});
    write("text.vdb", "no volume at all");
    expect_refused("text.vdb", "density", {"is not a VDB file"});
}

TEST_F(BadInput, PipesAreNotWaitedFor) {
    ASSERT_EQ(::mkfifo((folder_ / "pipe.vdb").c_str(), 0600), 0);
    expect_refused("pipe.vdb", "density", {"'pipe.vdb' is a pipe or device"});
}

TEST_F(BadInput, MoreThanTheMemoryHolds) {
    expect_failure({"render", "scene.yaml", "--size", "16384x16384", "--layers", "all", "--set",
                    "water={bands: [400, 410, 420, 430, 440, 450, 460, 470, 480, 490, 500, 510, "
                    "520, 530, 540, 550, 560, 570, 580, 590, 600]}",
                    "--set", "lamps.left.intensity=1", "--set",
                    "geometry=[{type: plane, point: [0, 0, 4], normal: [0, 0, -1]}]"},
                   3, "GB are free; ask for fewer --layers, a --crop or a smaller --size");
    // A part of such an image is small.
    const auto part = render({"--size", "16384x9433", "--crop", "8000,4500,8008,4504"});
    EXPECT_EQ(part.width, 8);
    EXPECT_EQ(part.full_height, 9433);
}

}  // namespace
}  // namespace uw
