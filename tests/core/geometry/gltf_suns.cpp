// ctest labels: unit analytic
// Directional lights of glTF files.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>

#include "core/geometry/gltf_import.h"
#include "core/scene/scene_desc.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

/// A scene under a surface at y = 9 with the directional light of a file, which its node turns from
/// -z to -y and moves, which means nothing.
SceneDesc sunlit_scene(const std::string& units) {
    const test::SceneFolder folder;
    folder.write("x.gltf", test::gltf_text({
                               {"extensions", R"({"KHR_lights_punctual":{"lights":[
                                   {"type":"directional","intensity":3415,"color":[1,0.5,0.25]}]}})"},
                               {"nodes", R"([{"name":"Sun","translation":[5,6,7],
                                   "rotation":[-0.70710678,0,0,0.70710678],
                                   "extensions":{"KHR_lights_punctual":{"light":0}}}])"},
                               {"scenes", R"([{"nodes":[0]}])"},
                           }));
    SceneDesc desc =
        read_scene(folder.write("scene.yaml",
                                "uwvdb: 1\ncamera: {resolution: [30, 20], intrinsics: {fx: 77}}\n"
                                "water: {surface: {point: [0, 9, 0], normal: [0, 1, 0]}}\n"
                                "geometry: [{file: x.gltf, lamps: all, light_units: " +
                                    units + "}]\n"),
                   {});
    import_gltf(desc);
    return desc;
}

TEST(GltfSuns, StandUnderTheWatersSurfaceWithLuxOrWatts) {
    for (const auto& [units, irradiance] :
         {std::pair{"standard", 5.0}, {"compat", 5.0 * 683}, {"raw", 5.0 * 683}}) {
        const SceneDesc desc = sunlit_scene(units);
        ASSERT_EQ(desc.lamps.size(), 1U);
        const LampDesc& sun = desc.lamps[0];
        EXPECT_EQ(sun.name, "Sun");
        ASSERT_TRUE(sun.sun);
        EXPECT_EQ(sun.sun->angle, 0);
        EXPECT_EQ(sun.sun->surface, (WaterSurfaceDesc{{0, 9, 0}, {0, 1, 0}}));
        // The node's rotation has eight digits.
        EXPECT_NEAR(glm::length(sun.direction - Vector3(0, -1, 0)), 0, 1e-7);
        EXPECT_FALSE(sun.fixed_to_camera);
        const std::array colors{1.0, 0.5, 0.25};
        for (std::size_t b = 0; b < 3; ++b)
            EXPECT_NEAR(sun.intensity->at(b), irradiance * colors[b], 1e-9 * irradiance) << units;
        EXPECT_TRUE(desc.warnings.empty());
    }
}

}  // namespace
}  // namespace uw
