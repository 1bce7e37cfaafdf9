// ctest labels: unit analytic
// Points in the images of a rig's cameras.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

class Disparity : public testing::Test {
  protected:
    SceneDesc load(const std::string& text) const {
        return load_scene(folder_.write("scene.yaml", "uwvdb: 1\n" + text), {});
    }
    static Film render(const SceneDesc& all, const ImageChoice& choice, const std::string& layers) {
        Renderer renderer;
        renderer.set_scene(scene_of_image(all, choice));
        renderer.render({.layers = layers});
        return renderer.release_film();
    }
    SceneFolder folder_;
};

// Rectified: the disparity is f b / Z, in both images, and nothing differs in y.
TEST_F(Disparity, OfARectifiedPairIsThatOfStereo) {
    const SceneDesc scene = load(
        "rig: {pose: {position: [0.3, 0, -1], rotate: [5, 10, 0]}}\n"
        "cameras:\n"
        "  - {name: left, resolution: [30, 20], intrinsics: {fx: 25}}\n"
        "  - {name: right, resolution: [30, 20], intrinsics: {fx: 25}, pose: {position: [0.2, 0, "
        "0], rotate: [0, 0, 0]}}\n"
        "geometry:\n"
        "  - {type: plane, point: [0, 0, 4], normal: [0.2, 0.1, -1]}\n"
        "  - {type: box, min: [-0.3, -0.3, 1], max: [0.4, 0.3, 1.5]}\n");
    for (const std::size_t camera : {0U, 1U}) {
        const Film film = render(scene, {{}, camera}, "depth,disparity,disparity_occluded");
        int hidden = 0;
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 30; ++x) {
                const auto channels = film.pixel(x, y);
                EXPECT_NEAR(double{channels[5]}, 25 * 0.2 / double{channels[4]}, 1e-5);
                EXPECT_NEAR(double{channels[6]}, 0, 1e-5);
                const double there = x + 0.5 + (camera == 0 ? -1 : 1) * double{channels[5]};
                if (there < 0 || there >= 30) {
                    EXPECT_EQ(channels[7], 1);
                } else {
                    hidden += channels[7] == 1 ? 1 : 0;
                }
            }
        EXPECT_GT(hidden, 3);  // beside the box
        EXPECT_LT(hidden, 100);
    }
}

// Behind ports and turned to each other: the pixel's own point, projected by both cameras.
TEST_F(Disparity, OfAnyPairIsFromCameraToCamera) {
    const SceneDesc scene = load(
        "cameras:\n"
        "  - {name: a, resolution: [30, 20], intrinsics: {fx: 25}, port: {distance: 0.03}}\n"
        "  - {name: b, resolution: [40, 20], intrinsics: {fx: 30}, port: {type: dome, radius: "
        "0.1}, "
        "pose: {position: [0.3, 0.1, 0], rotate: [2, -6, 3]}}\n"
        "  - {name: c, resolution: [30, 20], intrinsics: {fx: 25}, pose: {position: [-0.3, 0, 0], "
        "rotate: [0, 5, 0]}}\n"
        "geometry: [{type: plane, point: [0, 0, 3], normal: [0.2, 0.1, -1]}]\n");
    for (const auto& [camera, other] : {std::pair{0U, 1U}, {1U, 0U}, {2U, 0U}}) {
        const Film film = render(scene, {{}, camera}, "disparity,disparity_occluded");
        const Camera here(scene.cameras[camera].camera), there(scene.cameras[other].camera);
        const double sign = camera == 0 ? 1 : -1;
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x) {
                const auto channels = film.pixel(x, y);
                const auto ray = here.refracted_ray(x + 0.5, y + 0.5);
                ASSERT_TRUE(ray);
                const Vector3 normal(0.2, 0.1, -1);
                const Point3 point = ray->at(glm::dot(Point3{0, 0, 3} - ray->origin, normal) /
                                             glm::dot(ray->direction, normal));
                const auto seen = there.project(point);
                ASSERT_TRUE(seen);
                EXPECT_NEAR(double{channels[4]}, sign * (x + 0.5 - seen->x), 1e-4);
                EXPECT_NEAR(double{channels[5]}, sign * (y + 0.5 - seen->y), 1e-4);
                const bool within = seen->x >= 0 && seen->y >= 0 && seen->x < there.width() &&
                                    seen->y < there.height();
                EXPECT_EQ(channels[6], within ? 0 : 1);
            }
    }
}

TEST_F(Disparity, AndFlowAreNotInAll) {
    const SceneDesc scene = load("camera: {resolution: [30, 20], intrinsics: {fx: 25}}\n");
    const ImageScene image = scene_of_image(scene, {1});
    EXPECT_FALSE(layer_plan(image, "all").has(Layer::flow));
    EXPECT_TRUE(layer_plan(image, "all,flow").has(Layer::flow));
    EXPECT_NE(message_of<UsageError>([&] {
                  layer_plan(scene_of_image(scene, {}), "flow");
              }).find("--layers: flow: other frames are those of a sequence; give its --frames"),
              std::string::npos);
    EXPECT_NE(message_of<UsageError>([&] {
                  layer_plan(image, "disparity");
              }).find("needs a rig of at least two cameras"),
              std::string::npos);
}

}  // namespace
}  // namespace uw::test
