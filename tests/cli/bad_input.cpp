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
    expect_failure({"render", "scene.yaml", "--size", "32768x32768", "--layers", "all", "--set",
                    "water={bands: [400, 410, 420, 430, 440, 450, 460, 470, 480, 490, 500, 510, "
                    "520, 530, 540, 550, 560, 570, 580, 590, 600]}",
                    "--set", "lamps.left.intensity=1", "--set",
                    "geometry=[{type: plane, point: [0, 0, 4], normal: [0, 0, -1]}]"},
                   3, "GB are free; ask for fewer --layers, a --crop or a smaller --size");
    // A part of such an image is small.
    const auto part = render({"--size", "32768x18867", "--crop", "16000,9000,16008,9004"});
    EXPECT_EQ(part.width, 8);
    EXPECT_EQ(part.full_height, 18867);
}

}  // namespace
}  // namespace uw
