// ctest labels: unit analytic
#include "render/correspondences.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <span>

#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/vehicle_gltf.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

using PointMotion = std::function<Point3(const Point3& point, std::uint32_t object)>;

Point3 still(const Point3& point, std::uint32_t /*object*/) {
    return point;
}

/// The camera and the surfaces of one frame, made as those of an image of it alone.
struct FrameView {
    FrameView(const SceneDesc& all, const ImageChoice& choice) {
        renderer.set_scene(scene_of_image(all, choice));
        renderer.assemble();
    }
    const Camera& camera() const { return *renderer.assembled().camera; }
    const Surfaces& surfaces() const { return *renderer.assembled().surfaces; }
    std::optional<SurfaceHit> hit(double x, double y) const {
        const auto ray = camera().refracted_ray(x, y);
        SurfaceHit hit;
        if (!ray || !surfaces().closest_hit(*ray, 1e30, hit)) return std::nullopt;
        return hit;
    }
    Renderer renderer;
};

/// How many pixels of each kind a check met.
struct Counts {
    int seen = 0, hidden = 0, outside = 0, none = 0;
};

class Flow : public testing::Test {
  protected:
    SceneDesc load(const std::string& text) const {
        return load_scene(folder_.write("scene.yaml", "uwvdb: 1\n" + text), {});
    }
    /// A scene of a floor, a wall and a box, seen by a camera of 30 x 20 pixels, with `camera`
    /// besides, which the trajectory takes along, and `box` of the box.
    SceneDesc load_room(const std::string& camera, const std::string& trajectory,
                        const std::string& box = "reflectance: 0.5") const {
        return load("camera: {resolution: [30, 20], " + camera + ", trajectory: " + trajectory +
                    "}\ngeometry:\n"
                    "  - {type: plane, point: [0, 0.8, 0], normal: [0.1, -1, 0]}\n"
                    "  - {type: plane, point: [0, 0, 5], normal: [0, 0.1, -1]}\n"
                    "  - {type: box, min: [-0.3, -0.3, 2], max: [0.4, 0.3, 2.5], " +
                    box +
                    "}\n  - {type: sphere, center: [0.9, 0, 3], radius: 0.4}\n"
                    "render: {samples: 1, fps: 10}\n");
    }
    Film render(const SceneDesc& all, const ImageChoice& choice, const std::string& layers) {
        Renderer renderer;
        renderer.set_scene(scene_of_image(all, choice));
        renderer.render({.layers = layers});
        return renderer.release_film();
    }

    /// Checks the flow from `frame` to `frame + step` pixel by pixel: the neighbour's own ray at
    /// the place that the flow names must pass through the point that `motion` makes of this
    /// frame's, to 1e-3 pixels, and see it unless the point is marked as hidden.
    Counts check(const SceneDesc& all, int frame, int step, const PointMotion& motion) {
        const bool forward = step > 0;
        const Film film = render(all, {frame}, forward ? "flow,flow_occluded" : "flow_back");
        const FrameView now(all, {frame}), then(all, {frame + step});
        Counts counts;
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x) {
                const auto channels = film.pixel(x, y);
                const auto hit = now.hit(x + 0.5, y + 0.5);
                const double u = x + 0.5 + double{channels[4]}, v = y + 0.5 + double{channels[5]};
                if (!hit || !std::isfinite(u)) {
                    ++counts.none;
                    continue;
                }
                const Point3 point = motion(hit->position, hit->object_id);
                const auto ray = then.camera().refracted_ray(u, v);
                if (!ray) {
                    ADD_FAILURE() << "no ray at " << u << ", " << v;
                    continue;
                }
                const Vector3 way = point - ray->origin;
                const double off = glm::length(glm::cross(way, ray->direction)) / glm::length(way);
                // Pixels per radian: focal lengths here are below 50 px, behind a port 70.
                EXPECT_LT(off * 70, 1e-3) << x << ", " << y;
                if (!forward) continue;
                const bool within = u >= 0 && v >= 0 && u < 30 && v < 20;
                SurfaceHit there;
                const bool found = then.surfaces().closest_hit(*ray, 1e30, there);
                const bool seen = found && there.distance > glm::length(way) * (1 - 1e-4);
                EXPECT_EQ(channels[6] == 0, within && seen) << x << ", " << y;
                ++(!within ? counts.outside : seen ? counts.seen : counts.hidden);
                if (within && seen) {
                    EXPECT_LT(distance(there.position, point), 1e-4);
                }
            }
        return counts;
    }

    SceneFolder folder_;
};

// It moves to the right and forward, and turns by 10 degrees a frame about an axis that is none of
// the camera's.
constexpr const char* k_turning =
    "{keyframes: [{time: 0, rotate: [0, 0, 0]}, {time: 0.1, position: [0.2, -0.05, 0.15], rotate: "
    "[3, 8, -5]}, {time: 0.2, position: [0.4, 0, 0.3], rotate: [2, 12, 4]}]}";

TEST_F(Flow, FollowsPointsThroughEveryPortAndLens) {
    for (const std::string camera :
         {"intrinsics: {fx: 25}",
          "intrinsics: {fx: 25}, port: {distance: 0.05, thickness: 0.03, normal: [0.1, -0.05, 1]}",
          "intrinsics: {fx: 20}, port: {type: dome, radius: 0.1, thickness: 0.01, center: [0.01, "
          "0, "
          "0.02]}",
          "intrinsics: {fx: 25, fy: 27, cx: 14}, distortion: {k: [-0.2, 0.05, 0.01], p: [0.01, "
          "-0.004]}, port: {distance: 0.02, thickness: 0.01}",
          "intrinsics: {fov_x: 150}, distortion: {model: fisheye}, port: {type: dome, radius: "
          "0.1}"}) {
        SCOPED_TRACE(camera);
        const SceneDesc scene = load_room(camera, k_turning);
        for (const int frame : {0, 1}) {
            const Counts counts = check(scene, frame, 1, still);
            EXPECT_GT(counts.seen, 250);
            EXPECT_GE(counts.hidden, 3);
            EXPECT_GT(counts.outside, 10);
        }
        const Counts back = check(scene, 2, -1, still);
        EXPECT_LT(back.none, 200);
    }
}

TEST_F(Flow, FollowsWhatMoves) {
    // The box goes down and turns by 30 degrees about y a frame, after its own transform.
    const SceneDesc scene = load_room(
        "intrinsics: {fx: 25}, port: {distance: 0.02, thickness: 0.02}", k_turning,
        "trajectory: {interpolation: linear, keyframes: [{time: 0}, {time: 0.1, position: [0, 0.2, "
        "0.3], rotate: [0, 30, 0]}, {time: 0.2, position: [0, 0.4, 0.6], rotate: [0, 60, 0]}]}");
    const auto box_at = [](int frame) {
        return Affine::translation({0, 0.2 * frame, 0.3 * frame}) *
               Affine::rotation_xyz_degrees({0, 30.0 * frame, 0});
    };
    for (const int step : {1, -1}) {
        int moved = 0;
        const Affine motion = box_at(1 + step) * box_at(1).inverse();
        check(scene, 1, step, [&](const Point3& point, std::uint32_t object) {
            if (object != 3) return point;
            ++moved;
            return motion * point;
        });
        EXPECT_GT(moved, 20);
    }
}

// The crate turns by 2 radians and grows by half while it goes from Blender's frame 0 to 12: at two
// frames per second from one frame to the next. Its four corners, as Blender has them, tell where
// all of its points are.
TEST_F(Flow, FollowsAnimatedNodes) {
    folder_.write("vehicle.gltf", vehicle_gltf());
    const SceneDesc scene = load(
        "camera: {resolution: [30, 20], intrinsics: {fx: 45}, pose: {position: [1.1, 0.1, -1], "
        "look_at: [1.2, 0.1, -3]}}\n"
        "geometry: [{file: vehicle.gltf, transform: {scale: 2, translate: [-1.1, 0, 2.5]}}]\n"
        "render: {samples: 1, fps: 2}\n");
    const auto frame_of = [](const VehicleFrame& frame) {
        const auto corner = [&](std::size_t k) {
            const auto& c = frame.crate[k];
            return Vector3(2 * c[0] - 1.1, 2 * c[1], 2 * c[2] + 2.5);
        };
        return Affine(Matrix3(corner(1) - corner(0), corner(2) - corner(0), corner(3) - corner(0)),
                      corner(0));
    };
    const Affine motion =
        frame_of(k_vehicle_frames.back()) * frame_of(k_vehicle_frames.front()).inverse();
    int moved = 0;
    const Counts counts = check(scene, 0, 1, [&](const Point3& point, std::uint32_t /*object*/) {
        ++moved;
        return motion * point;
    });
    EXPECT_GT(moved, 10);
    EXPECT_GT(counts.seen + counts.hidden + counts.outside, 10);
}

// A mesh of 33 triangles that two nodes share, so that both are instances: the first stands still,
// the second moves along its parent's turned axes, by (0.5, 0.25, 0) a second.
TEST_F(Flow, FollowsInstances) {
    std::vector<std::uint16_t> corners;
    for (int k = 0; k < 33; ++k) corners.insert(corners.end(), {0, 1, 2});
    const std::string buffer = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + bytes_of(corners) +
                               std::string(2, '\0') + bytes_of<float>({0, 1}) +
                               bytes_of<float>({0, 0, 0, 0.5F, 0.25F, 0});
    folder_.write(
        "pair.gltf",
        gltf_text(
            {{"scenes", R"([{"nodes":[0,1]}])"},
             {"nodes", R"([{"mesh":0,"name":"still","translation":[-1.2,0,0]},
                 {"children":[2],"rotation":[0,0,0.70710678118654752,0.70710678118654752]},
                 {"mesh":0,"name":"moves"}])"},
             {"meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])"},
             {"animations",
              R"([{"channels":[{"sampler":0,"target":{"node":2,"path":"translation"}}],
                 "samplers":[{"input":2,"output":3}]}])"},
             {"accessors", R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                 {"bufferView":1,"componentType":5123,"count":99,"type":"SCALAR"},
                 {"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},
                 {"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}])"},
             {"bufferViews", R"([{"buffer":0,"byteLength":36},
                 {"buffer":0,"byteOffset":36,"byteLength":198},
                 {"buffer":0,"byteOffset":236,"byteLength":8},
                 {"buffer":0,"byteOffset":244,"byteLength":24}])"},
             {"buffers", R"([{"byteLength":268,"uri":"data:application/octet-stream;base64,)" +
                             base64(buffer) + R"("}])"}}));
    const SceneDesc scene = load(
        "camera: {resolution: [30, 20], intrinsics: {fx: 25}, port: {distance: 0.02}, pose: "
        "{position: [-0.5, 0.4, 2.5], look_at: [-0.5, 0.4, 0]}}\n"
        "geometry: [{file: pair.gltf}]\nrender: {samples: 1, fps: 2}\n");
    int moved = 0, stood = 0;
    check(scene, 0, 1, [&](const Point3& point, std::uint32_t object) {
        ++(object == 2 ? moved : stood);
        // A quarter turn about z makes (0.25, 0.125) of half a second (-0.125, 0.25).
        return object == 2 ? point + Vector3(-0.125, 0.25, 0) : point;
    });
    EXPECT_GT(moved, 20);
    EXPECT_GT(stood, 20);
}

TEST_F(Flow, IsNoneWithoutANeighbourOrAPoint) {
    const SceneDesc scene = load_room("intrinsics: {fx: 25}", k_turning);
    const Film last = render(scene, {2}, "flow,flow_occluded,flow_back");
    const Film first = render(scene, {0}, "flow,flow_back");
    for (int x = 0; x < 30; ++x) {
        const auto end = last.pixel(x, 10), begin = first.pixel(x, 10);
        EXPECT_TRUE(std::isnan(end[4]) && std::isnan(end[5]) && std::isnan(end[8])) << x;
        EXPECT_TRUE(std::isfinite(end[6])) << x;
        EXPECT_TRUE(std::isfinite(begin[4]) && std::isnan(begin[6])) << x;
    }
    // Nothing is seen: no flow.
    const SceneDesc open = load("camera: {resolution: [8, 6], intrinsics: {fx: 25}, trajectory: " +
                                std::string(k_turning) + "}\nrender: {fps: 10}\n");
    const Film nothing = render(open, {0}, "flow,flow_occluded");
    for (const float value : nothing.pixel(3, 3).subspan(4)) EXPECT_TRUE(std::isnan(value));
}

// Built for the flow of one frame, they are those of the next.
TEST_F(Flow, SurfacesOfTheNextFrameAreBuiltOnce) {
    const SceneDesc scene =
        load_room("intrinsics: {fx: 25}", k_turning,
                  "trajectory: {keyframes: [{time: 0}, {time: 0.2, position: [0, 0.2, 0.3]}]}");
    Renderer renderer;
    std::vector<Film> films;
    for (int frame = 0; frame < 3; ++frame) {
        renderer.set_scene(scene_of_image(scene, {frame}));
        renderer.render({.layers = "all,flow,flow_back,flow_occluded"});
        films.push_back(renderer.release_film());
    }
    for (int frame = 0; frame < 3; ++frame) {
        const Film alone = render(scene, {frame}, "all,flow,flow_back,flow_occluded");
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 30; ++x) {
                const std::span<const float> a = films[std::size_t(frame)].pixel(x, y),
                                             b = alone.pixel(x, y);
                ASSERT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0) << frame;
            }
    }
}

}  // namespace
}  // namespace uw::test
