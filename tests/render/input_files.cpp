// ctest labels: unit
#include "render/scene_loading.h"

#include <gtest/gtest.h>

#include <set>

#include "render/image_scene.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

constexpr const char* k_scene = R"(uwvdb: 1
cameras:
  - {name: left, calibration: {file: rig.yaml, camera: cam0}}
  - {name: right, calibration: {file: rig.yaml, camera: cam1}, pose: {position: [1, 0, 0], look_at: [1, 0, 1], up: [0, -1, 0]}}
water:
  scattering: {b: 0.2, phase: {type: table, file: water.csv}}
  species:
    silt: {size: {type: table, file: sizes.csv}, index: {file: quartz.csv}, coat: {thickness: 0.1 um, index: {file: film.csv}}}
    mud: {vsf: mud.csv, water: removed, absorption: {file: mud-absorption.csv}}
  surface: {point: [0, 5, 0], normal: [0, 1, 0]}
  profile: ctd.csv
volumes:
  - file: smoke_####.vdb
    velocity: {grid: v, file: wind_####.vdb}
    grids:
      density: {absorption: 0.1, scattering: 0.1, phase: {type: table, file: smoke.csv}}
geometry:
  - {type: plane, point: [0, 0, 4], normal: [0, 0, -1]}
  - {file: wall.obj}
  - {file: sub/ship_####.gltf}
lamps:
  - name: lamp
    position: [0, 0, 0]
    profile: {type: ies, file: lamp.ies}
    spectrum: {file: spectrum.csv}
render: {shutter: 0.01, response: camera.csv, white: {file: white.csv}}
)";

std::string camchain() {
    std::string text;
    for (const char* camera : {"cam0", "cam1"})
        text += std::string(camera) +
                ":\n  camera_model: pinhole\n  intrinsics: [30, 30, 16, 9]\n"
                "  distortion_model: radtan\n  distortion_coeffs: [0, 0, 0, 0]\n"
                "  resolution: [32, 18]\n";
    return text;
}

// The scene's files, none of which but the scene and the calibration is read here.
class InputFiles : public testing::Test {
  protected:
    InputFiles() {
        for (const char* name :
             {"water.csv", "smoke_0001.vdb", "wind_0001.vdb", "smoke.csv", "wall.obj", "lamp.ies",
              "spectrum.csv", "camera.csv", "white.csv", "sizes.csv", "quartz.csv", "film.csv",
              "mud.csv", "mud-absorption.csv", "ctd.csv"})
            folder_.write(name, "");
        folder_.write("rig.yaml", camchain());
        folder_.write("sub/ship_0001.gltf",
                      gltf_text({{"buffers", R"([{"uri":"ship%20one.bin","byteLength":8},
                                                 {"uri":"data:;base64,AAAA","byteLength":3}])"},
                                 {"images", R"([{"uri":"hull.png"},{"bufferView":0}])"}}));
        folder_.write("scene.yaml", k_scene);
    }

    std::multiset<std::string> names_of(const SceneDesc& scene,
                                        const ImageChoice& choice = {}) const {
        std::multiset<std::string> names;
        SideFiles known;
        for (const InputFile& input : input_files(scene, choice, known))
            names.insert(input.file.lexically_relative(folder_.path()).string());
        return names;
    }

    SceneFolder folder_;
};

TEST_F(InputFiles, AreAllThatASceneNames) {
    const SceneDesc scene = load_scene(folder_.path() / "scene.yaml", {});
    EXPECT_EQ(
        names_of(scene, {1}),
        (std::multiset<std::string>{"scene.yaml",       "rig.yaml",           "rig.yaml",
                                    "water.csv",        "smoke_0001.vdb",     "wind_0001.vdb",
                                    "smoke.csv",        "wall.obj",           "sub/ship_0001.gltf",
                                    "sub/ship one.bin", "sub/hull.png",       "lamp.ies",
                                    "spectrum.csv",     "camera.csv",         "white.csv",
                                    "sizes.csv",        "quartz.csv",         "film.csv",
                                    "mud.csv",          "mud-absorption.csv", "ctd.csv"}));
    SideFiles known;
    for (const InputFile& input : input_files(scene, {}, known)) {
        const std::string name = input.file.filename().string();
        EXPECT_EQ(input.is_hashed, name == "scene.yaml" || name == "rig.yaml") << name;
        EXPECT_FALSE(input.what.empty()) << name;
    }
}

TEST_F(InputFiles, OfASensorAreItsTables) {
    folder_.write("scene.yaml",
                  "uwvdb: 1\ncamera:\n  resolution: [4, 3]\n  intrinsics: {fov_x: 60}\n"
                  "  lens: {f_number: 2, focal_length: 0.01}\n"
                  "  sensor: {exposure: 1, gain: 1, quantum_efficiency: white.csv,\n"
                  "    image: {response: camera.csv}}\n");
    const SceneDesc scene = load_scene(folder_.path() / "scene.yaml", {});
    EXPECT_EQ(names_of(scene),
              (std::multiset<std::string>{"scene.yaml", "white.csv", "camera.csv"}));
}

TEST_F(InputFiles, OfASceneWithoutAnyAreTheSceneAlone) {
    folder_.write("scene.yaml",
                  "uwvdb: 1\ncamera: {resolution: [4, 3], intrinsics: {fov_x: 60}}\n"
                  "lamps: [{name: a, position: [0, 0, 0], intensity: 1}]\n");
    const SceneDesc scene = load_scene(folder_.path() / "scene.yaml", {});
    EXPECT_EQ(names_of(scene), std::multiset<std::string>{"scene.yaml"});
}

TEST_F(InputFiles, ThatAreMissingOrBrokenAreListedAllTheSame) {
    const SceneDesc scene = load_scene(folder_.path() / "scene.yaml", {});
    EXPECT_EQ(names_of(scene, {7}).count("sub/ship_0007.gltf"), 1U);
    folder_.write("sub/ship_0001.gltf", R"({"asset":{"version":"2.0"},"buffers":[7,{"uri":[]}]})");
    EXPECT_EQ(names_of(scene, {1}).count("sub/ship_0001.gltf"), 1U);
}

}  // namespace
}  // namespace uw::test
