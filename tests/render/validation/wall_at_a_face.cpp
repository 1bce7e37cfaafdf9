// ctest labels: analytic
// Water that ends everywhere exactly at the far face of the last slab.
#include <gtest/gtest.h>

#include "render/scene_loading.h"
#include "render/validation/validation.h"

namespace uw::test {
namespace {

// A wall parallel to the image plane, seen without a port that tilts the rays.
TEST(Validation, PassesWhereAWallEndsTheLastSlab) {
    SceneDesc scene = load_scene_text(
        "uwvdb: 1\n"
        "camera: {resolution: [16, 12], intrinsics: {fov_x: 60}}\n"
        "water:\n"
        "  bands: [620, 540, 450]\n"
        "  absorption: [0.35, 0.08, 0.05]\n"
        "  scattering: {b: [0.20, 0.22, 0.25], phase: {type: hg, g: 0.9}}\n"
        "  forward_scatter: {K: 1, G: 0.02, B: 0.1}\n"
        "geometry: [{type: plane, point: [0, 0, 4], normal: [0, 0, -1], reflectance: 0.5}]\n"
        "lamps: [{name: bare, position: [1, -0.5, 0], intensity: [50, 50, 50]}]\n",
        "wall.yaml");
    const SceneValidation result = validate_scene(std::move(scene), "wall", {});
    bool has_planes = false;
    for (const Check& check : result.checks) {
        EXPECT_TRUE(check.passed())
            << check.left << " - " << check.right << ", " << check.component.name << " in band "
            << check.band << ": " << check.largest << ", " << check.rms;
        has_planes = has_planes || (check.right == "planes, 512" && check.pixels > 100);
    }
    EXPECT_TRUE(has_planes);
}

}  // namespace
}  // namespace uw::test
