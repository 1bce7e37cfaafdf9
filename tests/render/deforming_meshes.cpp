// ctest labels: unit analytic
//
// Meshes whose vertices move against each other: their flow and their blur against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/image_scene.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/image_of.h"
#include "tests/support/meshes/gltf_builder.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

// Frame 10 is at 1 s.
constexpr int k_square_frame = 10;
constexpr int k_square_width = 48, k_square_height = 32;
constexpr double k_square_focal = 100;  // [px]

/// A square in the plane z = 2 with corners at x and y of +-0.2, whose morph target of weight t at
/// t seconds moves its corners by these velocities [m/s].
std::string moving_square(const std::vector<float>& velocities) {
    GltfBuilder builder;
    const std::string positions =
        builder.add("VEC3", {-.2F, -.2F, 2, .2F, -.2F, 2, .2F, .2F, 2, -.2F, .2F, 2});
    const std::string target = builder.add("VEC3", velocities);
    const std::string indices = builder.add_shorts("SCALAR", {0, 1, 2, 0, 2, 3});
    // About 1 s, so that the square has its written shape in frame 10.
    const std::string times = builder.add_times({0, 2}), weights = builder.add("SCALAR", {-1, 1});
    return builder.text(
        R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":)"
        R"({"POSITION":)" +
        positions + R"(},"targets":[{"POSITION":)" + target + R"(}],"indices":)" + indices +
        R"(}]}],"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}],)"
        R"("samplers":[{"input":)" +
        times + R"(,"output":)" + weights + "}]}]");
}

class DeformingMeshes : public testing::Test {
  protected:
    /// A scene of that square, lit evenly from far behind the camera, in clear water.
    SceneDesc scene(const std::vector<float>& velocities, const std::string& render = "",
                    const std::string& entry = "") const {
        folder_.write("square.gltf", moving_square(velocities));
        return load_scene(
            folder_.write(
                "scene.yaml",
                "uwvdb: 1\ncamera: {resolution: [48, 32], intrinsics: {fx: 100}}\n"
                "water: {bands: [620, 540, 450], absorption: [0, 0, 0], scattering: {b: [0, 0, "
                "0], phase: {type: hg, g: 0.9}}}\n"
                "geometry: [{file: square.gltf" +
                    entry +
                    "}]\n"
                    "lamps: [{name: far, frame: world, position: [0, 0, -99], direction: [0, 0, "
                    "1], profile: {type: isotropic}, intensity: [1e4, 1e4, 1e4]}]\n"
                    "render: {fps: 10" +
                    render + "}\n"),
            {});
    }
    static Film image(const SceneDesc& scene, const std::string& layers) {
        return image_of(scene_of_image(scene, {k_square_frame}), {.layers = layers});
    }
    static std::vector<float> all_by(float x, float y, float z) {
        std::vector<float> values;
        for (int corner = 0; corner < 4; ++corner) values.insert(values.end(), {x, y, z});
        return values;
    }
    SceneFolder folder_;
};

/// Checks the flow of every pixel on the square: `velocity(x, y)` is that of its point [m/s].
template <class Velocity>
int check_flow(const Film& film, int channel, double seconds, const Velocity& velocity) {
    int seen = 0;
    for (int j = 0; j < k_square_height; ++j)
        for (int i = 0; i < k_square_width; ++i) {
            const double x = (i + 0.5 - k_square_width / 2.0) / k_square_focal * 2,
                         y = (j + 0.5 - k_square_height / 2.0) / k_square_focal * 2;
            if (std::abs(x) > 0.199 || std::abs(y) > 0.199) continue;
            const Vector3 there = Vector3(x, y, 2) + seconds * velocity(x, y);
            const auto pixel = film.pixel(i, j);
            const auto at = static_cast<std::size_t>(channel);
            EXPECT_NEAR(double{pixel[at]}, k_square_focal * (there.x / there.z - x / 2), 1e-3)
                << i << ", " << j;
            EXPECT_NEAR(double{pixel[at + 1]}, k_square_focal * (there.y / there.z - y / 2), 1e-3)
                << i << ", " << j;
            ++seen;
        }
    return seen;
}

// Only corner 2 moves, also towards the camera: points of both triangles follow it by their
// barycentric coordinate.
TEST_F(DeformingMeshes, FlowFollowsThePointsOfTriangles) {
    const Vector3 corner(0.5, -0.25, -1);
    const auto velocity = [&](double x, double y) { return (std::min(x, y) + 0.2) / 0.4 * corner; };
    for (const std::string entry : {"", ", material: {type: glass, thin: true}"}) {
        const SceneDesc desc = scene({0, 0, 0, 0, 0, 0, 0.5F, -0.25F, -1, 0, 0, 0}, "", entry);
        const Film film = image(desc, "flow,flow_occluded,flow_back");
        const auto& names = film.channel_names();
        ASSERT_EQ(names.at(4), "flow.X");
        ASSERT_EQ(names.at(6), "flow_back.X");
        EXPECT_GT(check_flow(film, 4, 0.1, velocity), 300);
        ASSERT_EQ(names.at(8), "flow_occluded.V");
        EXPECT_GT(check_flow(film, 6, -0.1, velocity), 300);
        // Nothing hides the square from itself.
        EXPECT_EQ(film.pixel(20, 12)[8], 0);
        EXPECT_EQ(film.pixel(k_square_width / 2, k_square_height / 2)[8], 0);
    }
}

// The file's own motion is that of its vertices; the object's trajectory moves them besides.
TEST_F(DeformingMeshes, FlowAddsTheTrajectory) {
    const SceneDesc desc = scene(all_by(0.3F, 0, 0), "",
                                 ", trajectory: {interpolation: linear, keyframes: [{time: 0, "
                                 "position: [0, -0.4, 0], rotate: [0, 0, 0]}, {time: 2, position: "
                                 "[0, 0.4, 0], rotate: [0, 0, 0]}]}");
    const Film film = image(desc, "flow");
    EXPECT_GT(check_flow(film, 4, 0.1, [](double, double) { return Vector3(0.3, 0.4, 0); }), 300);
}

/// The mean over a pixel, its centre at `x` from the edge, and over the exposure of what lies to
/// the left of an edge that moves over `way` pixels: two boxes convolved, then a step.
double ramp(double x, double way) {
    double sum = 0;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-1.0, 1.0}) {
            const double t = std::max(0.0, -x + 0.5 * (a * way + b));
            sum += a * b * t * t / 2;
        }
    return sum / way;
}

// The right side moves, by `way` pixels while the shutter is open, and the left side does not.
TEST_F(DeformingMeshes, BlurIsARampWhereVerticesMove) {
    const std::vector<float> still(12, 0.0F);
    const double bright = double{image(scene(still, ", samples: 16"), "direct").pixel(24, 16)[0]};
    ASSERT_GT(bright, 0);
    for (const double way : {2.0, 8.0}) {
        // 0.02 m are a pixel at 2 m.
        const auto v = static_cast<float>(way * 0.02 / 0.04);
        const Film film = image(
            scene({0, 0, 0, v, 0, 0, v, 0, 0, 0, 0, 0}, ", shutter: 0.04, samples: 128"), "direct");
        for (int i = 0; i < k_square_width; ++i) {
            const double value = double{film.pixel(i, 16)[0]} / bright;
            const double x = i + 0.5 - k_square_width / 2.0;
            const double expected = x < 0 ? ramp(-10 - x, 1e-6) : ramp(x - 10, way);
            // Surfaces stand still in parts of the exposure in which they move by half a pixel: the
            // ramp is made of steps, off by a quarter of their height in the mean over a pixel.
            // Samples add up to 0.02.
            EXPECT_NEAR(value, x < 0 && std::abs(x + 10) > 0.6 ? (x < -10 ? 0 : 1) : expected,
                        0.125 / way + 0.02)
                << i << " " << way;
        }
    }
}

// With the shutter closed it is the image of a file that has that shape and no animation.
TEST_F(DeformingMeshes, WithoutAnExposureAreStillOnes) {
    const std::vector<float> velocities{0, 0, 0, 1, 0, 0, 1, 0.5F, -1, 0, 0, 0};
    const SceneDesc moving = scene(velocities);
    const Film found = image_of(scene_of_image(moving, {15}), {.layers = "direct,depth,normal"});
    std::string still = moving_square(velocities);
    const std::string animations = R"(,"animations")";
    still.replace(still.find(animations), animations.size(), R"(,"unused")");
    still.replace(still.find(R"("nodes":[{"mesh":0)"), 18, R"("nodes":[{"weights":[0.5],"mesh":0)");
    folder_.write("square.gltf", still);
    const SceneDesc same = load_scene(folder_.path() / "scene.yaml", {});
    EXPECT_FALSE(has_motion(same));
    const Film expected = image_of(same, {.layers = "direct,depth,normal"});
    EXPECT_TRUE(std::ranges::equal(found.values(), expected.values()));
    EXPECT_FALSE(std::ranges::equal(found.values(),
                                    image(scene(velocities), "direct,depth,normal").values()));
}

}  // namespace
}  // namespace uw::test
