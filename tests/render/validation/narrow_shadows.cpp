// ctest labels: analytic slow
// Scenes whose light or shadows are narrower than what the methods step over by themselves.
#include <gtest/gtest.h>

#include <filesystem>

#include "render/scene_loading.h"
#include "render/validation/validation.h"
#include "render/validation/validation_methods.h"

namespace uw::test {
namespace {

/// An example scene in a small image, by single scattering.
SceneValidation validate_example(const char* name) {
    SceneDesc scene =
        load_scene(std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/scenes" / name, {});
    scene.render.scattering = RenderDesc::Scattering::single;
    show_radiance_in_water(scene, 32);
    return validate_scene(std::move(scene), name, {});
}

// Shadows of a grating's bars, 4 mm wide, and a bulb that the camera looks past: narrower than the
// texels of a final image's shadow maps, and than a 512th of the ray.
TEST(Validation, PassesWhereLightAndShadowAreNarrow) {
    for (const char* name : {"housing.yaml", "blender.yaml"}) {
        const SceneValidation result = validate_example(name);
        for (const Check& check : result.checks) {
            EXPECT_TRUE(check.passed())
                << name << ": " << check.left << " - " << check.right << ", "
                << check.component.name << " in band " << check.band;
            // The sums over planes were refined until what they may be off by says something.
            EXPECT_LT(check.own, 0.005) << name;
        }
        EXPECT_GT(result.planes.back().count, 512) << name;
    }
}

}  // namespace
}  // namespace uw::test
