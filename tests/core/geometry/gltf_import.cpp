// ctest labels: unit analytic
#include "core/geometry/gltf_import.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/scene/scene_desc.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

const std::filesystem::path k_data = std::filesystem::path(UWVDB_SOURCE_DIR) / "tests/data";

constexpr auto k_nodes =
    R"([{"mesh":0},{"camera":0,"name":"Eye","translation":[1,2,3]},
        {"name":"Sun","extensions":{"KHR_lights_punctual":{"light":0}}},
        {"name":"Bulb 1","translation":[0,5,0],"extensions":{"KHR_lights_punctual":{"light":1}}},
        {"name":"Bulb.1","extensions":{"KHR_lights_punctual":{"light":2}}}])";
constexpr auto k_cameras =
    R"([{"type":"perspective","perspective":{"yfov":1,"aspectRatio":1.5,"znear":1}},
        {"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":1,"zfar":2}}])";
constexpr auto k_lights =
    R"({"KHR_lights_punctual":{"lights":[{"type":"directional"},
        {"type":"point","intensity":683,"range":7},{"type":"spot","spot":{}}]}})";

class GltfImport : public testing::Test {
  protected:
    /// A scene whose only entry is x.glb with `keys`.
    SceneDesc scene(const std::string& keys, const std::string& camera = "",
                    const std::map<std::string, std::string>& changes = {}) {
        std::map<std::string, std::string> parts{{"nodes", k_nodes},
                                                 {"scenes", R"([{"nodes":[0,1,2,3,4]}])"},
                                                 {"cameras", k_cameras},
                                                 {"extensions", k_lights}};
        for (const auto& [key, value] : changes) parts[key] = value;
        folder_.write("x.gltf", test::gltf_text(parts));
        SceneDesc desc = read_scene(
            folder_.write("scene.yaml", "uwvdb: 1\ncamera: {resolution: [300, 200]" + camera +
                                            "}\ngeometry: [{file: x.gltf" + keys + "}]\n"),
            {});
        import_gltf(desc);
        return desc;
    }
    std::string error_of(const std::string& keys, const std::string& camera = "",
                         const std::map<std::string, std::string>& changes = {}) {
        try {
            scene(keys, camera, changes);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no InputError";
    }
    void expect_error(const std::string& part, const std::string& keys,
                      const std::string& camera = "",
                      const std::map<std::string, std::string>& changes = {}) {
        const std::string error = error_of(keys, camera, changes);
        EXPECT_NE(error.find(part), std::string::npos) << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }

    test::SceneFolder folder_;
};

TEST(GltfImportOfBlender, LampsAreWattsOverFourPiInAllThreeUnits) {
    const test::SceneFolder folder;
    for (const auto& [file, units] : {std::pair{"lights_spec.gltf", "standard"},
                                      {"lights_compat.gltf", "compat"},
                                      {"lights_raw.gltf", "raw"}}) {
        SceneDesc scene = read_scene(
            folder.write("scene.yaml",
                         "uwvdb: 1\ncamera: {resolution: [4, 3]}\ngeometry: [{file: '" +
                             (k_data / file).string() +
                             "', camera: true, lamps: all, light_units: " + units + "}]\n"),
            {});
        EXPECT_TRUE(scene.warnings.empty());
        import_gltf(scene);
        EXPECT_TRUE(scene.warnings.empty());
        ASSERT_EQ(scene.lamps.size(), 3U) << file;
        const double watts[] = {120, 80, 30};
        const double colors[3][3] = {{1, 0.96, 0.9}, {1, 1, 1}, {0.8, 0.9, 1}};
        const char* const names[] = {"SpotLeft", "SpotRight", "PointFill"};
        for (std::size_t j = 0; j < 3; ++j) {
            const LampDesc& lamp = scene.lamps[j];
            EXPECT_EQ(lamp.name, names[j]);
            EXPECT_FALSE(lamp.fixed_to_camera);
            for (std::size_t c = 0; c < 3; ++c) {
                const double expected = watts[j] / (4 * std::numbers::pi) * colors[j][c];
                EXPECT_NEAR(lamp.intensity->at(c), expected, 1e-6 * expected) << file;
            }
        }
        // 70 degrees wide with blend 0.2: full within 28, dark beyond 35 degrees of the axis.
        const auto& spot = std::get<SpotProfileDesc>(scene.lamps[0].profile);
        EXPECT_NEAR(spot.beam, 63, 1e-5);
        EXPECT_NEAR(spot.edge, 7, 1e-5);
        EXPECT_EQ(spot.falloff, SpotProfileDesc::Falloff::blender_3_4);  // who wrote them
        EXPECT_TRUE(std::holds_alternative<IsotropicProfileDesc>(scene.lamps[2].profile));
        // yfov of a camera of 65.47 x 51.48 degrees, 4 : 3.
        EXPECT_NEAR(scene.camera.intrinsics.fy, 1.5 / std::tan(0.8985201936400519 / 2), 1e-9);
        EXPECT_EQ(scene.camera.intrinsics.fx, scene.camera.intrinsics.fy);
        EXPECT_EQ(scene.camera.intrinsics.cx, 2);
        // The camera hangs on the robot at its origin.
        EXPECT_NEAR(scene.camera.world_from_camera.offset().z, 3.2, 1e-6);
    }
}

TEST_F(GltfImport, TheCameraLooksAlongMinusZWithYUp) {
    const SceneDesc desc = scene(", camera: true");
    const Matrix3& axes = desc.camera.world_from_camera.linear();
    EXPECT_EQ(axes[0], Vector3(1, 0, 0));
    EXPECT_EQ(axes[1], Vector3(0, -1, 0));
    EXPECT_EQ(axes[2], Vector3(0, 0, -1));
    EXPECT_EQ(desc.camera.world_from_camera.offset(), Vector3(1, 2, 3));
    EXPECT_NEAR(desc.camera.intrinsics.fx, 100 / std::tan(0.5), 1e-12);
    EXPECT_EQ(desc.lamps.size(), 0U);
}

TEST_F(GltfImport, TheEntrysTransformMovesCameraAndLampsWithoutScalingThem) {
    const SceneDesc desc = scene(
        ", camera: Eye, lamps: ['Bulb 1'], transform: {scale: [-2, 3, 4], rotate: [0, 90, "
        "0], translate: [0, 0, 1]}");
    // (1, 2, 3) -> (-2, 6, 12) -> about y: (12, 6, 2) -> (12, 6, 3).
    EXPECT_NEAR(glm::length(desc.camera.world_from_camera.offset() - Vector3(12, 6, 3)), 0, 1e-12);
    const Matrix3& axes = desc.camera.world_from_camera.linear();
    EXPECT_NEAR(glm::length(axes[2] - Vector3(-1, 0, 0)), 0, 1e-12);
    EXPECT_NEAR(glm::length(axes[1] - Vector3(0, -1, 0)), 0, 1e-12);
    EXPECT_NEAR(glm::determinant(axes), 1, 1e-12);  // the mirror is left out
    ASSERT_EQ(desc.lamps.size(), 1U);
    EXPECT_NEAR(distance(desc.lamps[0].position, {0, 15, 1}), 0, 1e-12);
    EXPECT_NEAR(desc.lamps[0].intensity->at(0), 1, 1e-12);  // 683 cd
}

TEST_F(GltfImport, WhatTheSceneSaysItselfStands) {
    const SceneDesc posed = scene(", camera: true", ", pose: {look_at: [0, 0, 1]}");
    EXPECT_EQ(posed.camera.world_from_camera.offset(), Vector3(0.0));
    EXPECT_NEAR(posed.camera.intrinsics.fy, 100 / std::tan(0.5), 1e-12);
    const SceneDesc calibrated = scene(", camera: true", ", intrinsics: {fx: 77}");
    EXPECT_EQ(calibrated.camera.intrinsics.fx, 77);
    EXPECT_EQ(calibrated.camera.world_from_camera.offset(), Vector3(1, 2, 3));
    expect_error("which leaves nothing to take", ", camera: true",
                 ", intrinsics: {fx: 77}, pose: {look_at: [0, 0, 1]}");
    expect_error("scene.yaml:2:9: camera: 'intrinsics' is missing; give", ", lamps: all");
}

TEST_F(GltfImport, LensShiftIsTakenFromCustomProperties) {
    const auto camera_with = [&](const std::string& extras, const std::string& node_extras = "{}") {
        return scene(", camera: true", "",
                     {{"nodes", R"([{"mesh":0},{"camera":0,"extras":)" + node_extras + "}]"},
                      {"scenes", R"([{"nodes":[0,1]}])"},
                      {"cameras", R"([{"type":"perspective","extras":)" + extras +
                                      R"(,"perspective":{"yfov":1,"znear":1}}])"}})
            .camera.intrinsics;
    };
    // In Blender the frame moves right and up by fractions of its longer side, here 300 of 300 x
    // 200.
    const IntrinsicsDesc automatic = camera_with(R"({"shift_x":0.1,"shift_y":0.05})");
    EXPECT_NEAR(automatic.cx, 150 - 30, 1e-12);
    EXPECT_NEAR(automatic.cy, 100 + 15, 1e-12);
    EXPECT_NEAR(automatic.fx, 100 / std::tan(0.5), 1e-12);  // as without
    const IntrinsicsDesc vertical =
        camera_with(R"({"shift_x":0.1,"shift_y":-0.05,"sensor_fit":"VERTICAL","note":[1]})");
    EXPECT_NEAR(vertical.cx, 150 - 20, 1e-12);
    EXPECT_NEAR(vertical.cy, 100 - 10, 1e-12);
    EXPECT_NEAR(camera_with(R"({"shift_y":0.1,"sensor_fit":"HORIZONTAL"})").cy, 100 + 30, 1e-12);
    // The object's shift counts if both have one; what is no number belongs to somebody else.
    EXPECT_NEAR(camera_with(R"({"shift_x":0.1})", R"({"shift_x":0.2})").cx, 150 - 60, 1e-12);
    EXPECT_EQ(camera_with(R"({"shift_x":"0.1","sensor_fit":7})", "[]").cx, 150);
    EXPECT_EQ(camera_with("3").cx, 150);
    expect_error("lens shift", ", camera: true", "",
                 {{"cameras", R"([{"type":"perspective","extras":{"shift_x":1e30},
                                   "perspective":{"yfov":1,"znear":1}}])"}});
}

TEST_F(GltfImport, LightsThatNobodyTakesAreNamedInTheDark) {
    const SceneDesc dark = scene(", camera: true");
    ASSERT_EQ(dark.warnings.size(), 2U);  // there are no lamps
    EXPECT_NE(dark.warnings[1].find("lights that no key asks for: Sun, Bulb 1, Bulb.1; take them"),
              std::string::npos)
        << dark.warnings[1];
    for (const std::string& warning : scene(", camera: true, lamps: ['Bulb 1']").warnings)
        EXPECT_EQ(warning.find("no key"), std::string::npos) << warning;
}

TEST_F(GltfImport, AFileMayHoldNothingButACamera) {
    folder_.write("eye.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"camera":0}],
        "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}]})");
    SceneDesc desc = read_scene(folder_.write("scene.yaml",
                                              "uwvdb: 1\ncamera: {resolution: [30, 20]}\n"
                                              "geometry: [{file: eye.gltf, camera: true}]\n"),
                                {});
    import_gltf(desc);
    EXPECT_NEAR(desc.camera.intrinsics.fy, 10 / std::tan(0.5), 1e-12);
}

TEST_F(GltfImport, AnotherAspectIsSaid) {
    EXPECT_EQ(scene(", camera: true").warnings.size(), 2U);  // no lamps, though the file has lights
    const SceneDesc desc = scene(", camera: true, lamps: ['Bulb 1']", "", {{"cameras", R"(
        [{"type":"perspective","perspective":{"yfov":1,"aspectRatio":1,"znear":1}}])"}});
    ASSERT_GE(desc.warnings.size(), 1U);
    EXPECT_NE(desc.warnings[0].find("it shows more at the sides"), std::string::npos);
}

TEST_F(GltfImport, AllLampsButTheDirectionalWithNamesOfTheirOwn) {
    const SceneDesc desc = scene(", lamps: all", ", intrinsics: {fx: 77}");
    ASSERT_EQ(desc.lamps.size(), 2U);
    EXPECT_EQ(desc.lamps[0].name, "Bulb_1");
    EXPECT_EQ(desc.lamps[1].name, "Bulb_1_2");
    ASSERT_EQ(desc.warnings.size(), 2U);
    EXPECT_NE(desc.warnings[0].find("directional lights (suns) are left out: Sun"),
              std::string::npos);
    EXPECT_NE(desc.warnings[1].find(
                  "range of lights is ignored; they go on falling off as 1/r^2: Bulb 1"),
              std::string::npos);
    // The defaults of a spot: from the axis to 45 degrees, intensity 1.
    EXPECT_NEAR(std::get<SpotProfileDesc>(desc.lamps[1].profile).beam, 45, 1e-12);
    EXPECT_NEAR(std::get<SpotProfileDesc>(desc.lamps[1].profile).edge, 45, 1e-12);
    EXPECT_NEAR(desc.lamps[1].intensity->at(2), 1 / 683.0, 1e-15);
}

TEST_F(GltfImport, SpotsFallOffAsTheFilesWriterShadesThem) {
    using Falloff = SpotProfileDesc::Falloff;
    for (const auto& [generator, falloff] :
         {std::pair{"", Falloff::gltf},
          {"babylon.js 3.4", Falloff::gltf},
          {"Khronos Blender glTF 2.0 exporter", Falloff::blender_3_4},
          {"Khronos glTF Blender I/O v1.2.75", Falloff::blender_3_4},
          {"Khronos glTF Blender I/O v3.4.50", Falloff::blender_3_4},
          {"Khronos glTF Blender I/O v3.5.30", Falloff::blender},
          {"Khronos glTF Blender I/O v4.0.43", Falloff::blender},
          {"Khronos glTF Blender I/O v10.2.1", Falloff::blender}}) {
        const SceneDesc desc = scene(
            ", lamps: ['Bulb.1']", ", intrinsics: {fx: 77}",
            {{"asset", std::string(R"({"version":"2.0","generator":")") + generator + "\"}"}});
        EXPECT_EQ(std::get<SpotProfileDesc>(desc.lamps.at(0).profile).falloff, falloff)
            << generator;
    }
}

TEST_F(GltfImport, RefusesInOneLine) {
    const std::string own = ", intrinsics: {fx: 77}";
    expect_error("scene.yaml:3:35: geometry[0].camera: '", ", camera: Ear");
    expect_error("has no camera 'Ear'; it has Eye", ", camera: Ear");
    expect_error("has no camera; export it", ", camera: true", "",
                 {{"nodes", R"([{"mesh":0}])"}, {"scenes", R"([{"nodes":[0]}])"}});
    expect_error("has 2 cameras; name one of Eye, camera2", ", camera: true", "",
                 {{"nodes", R"([{"camera":0,"name":"Eye"},{"camera":1}])"},
                  {"scenes", R"([{"nodes":[0,1]}])"}});
    expect_error("the camera 'camera1' is orthographic", ", camera: true", "",
                 {{"nodes", R"([{"camera":1}])"}, {"scenes", R"([{"nodes":[0]}])"}});
    expect_error("the light 'Sun' is directional (a sun); say where the water's surface is",
                 ", lamps: [Sun]", own);
    expect_error("has no light 'Bob'; it has Sun, Bulb 1, Bulb.1", ", lamps: [Bob]", own);
    expect_error("light_units: has an effect only with lamps", ", light_units: raw", own);
    expect_error("light_units: unknown value 'rae'; did you mean 'raw'?",
                 ", lamps: all, light_units: rae", own);
    expect_error("material: unknown value 'metal'; use one of: diffuse, pbr", ", material: metal",
                 own);
    expect_error("lamps: lists no light", ", lamps: []", own);
    expect_error(
        "scale of 0", ", camera: true", "",
        {{"nodes", R"([{"camera":0,"scale":[1,1,0]}])"}, {"scenes", R"([{"nodes":[0]}])"}});
    const auto lights = [](const std::string& light) {
        return std::map<std::string, std::string>{
            {"extensions", R"({"KHR_lights_punctual":{"lights":[)" + light + "]}}"},
            {"nodes", R"([{"extensions":{"KHR_lights_punctual":{"light":0}}}])"},
            {"scenes", R"([{"nodes":[0]}])"}};
    };
    for (const auto& [light, part] :
         {std::pair{R"({"type":"area"})", "neither point"},
          {R"({"type":"point","intensity":-1})", "negative"},
          {R"({"type":"point","color":[1]})", "broken"},
          {R"({"type":"spot","spot":{"innerConeAngle":1}})", "cone angles"},
          {R"({"type":"spot","spot":{"outerConeAngle":2}})", "cone angles"}}) {
        expect_error(part, ", lamps: all", own, lights(light));
    }
    expect_error("refers to a light that does not exist", ", lamps: all", own, lights(""));
}

TEST_F(GltfImport, OnlyGltfBringsThem) {
    folder_.write("x.obj", "v 0 0 0\n");
    const auto file =
        folder_.write("scene.yaml",
                      "uwvdb: 1\ncamera: {resolution: [4, 3]}\ngeometry: [{file: x.obj, camera: "
                      "true}]\n");
    EXPECT_THROW(read_scene(file, {}), InputError);
}

}  // namespace
}  // namespace uw
