#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "render/image_scene.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/image_of.h"

/// A scene in which all moves while the shutter is open, and how far images of it are apart.
namespace uw::test {

// Frame 10 is at 1 s; the shutter is open from 0.98 s to 1.02 s.
inline constexpr int k_frame = 10;
inline constexpr double k_shutter = 0.04;

enum class Moves { all, camera_alone };

/// Camera, lamps and box move, each in its own way, in water.
inline ImageScene moving_scene(const std::string& render, const std::string& water = "",
                               Moves moves = Moves::all) {
    SceneDesc scene = load_scene_text(
        "uwvdb: 1\n"
        "camera: {resolution: [40, 36], intrinsics: {fx: 40}, port: {distance: 0.02, thickness: "
        "0.02}, lens: {f_number: 2.8, focal_length: 0.008}, trajectory: {keyframes: [{time: 0, "
        "position: [-3, 0.2, 0], rotate: [0, 40, 0]}, {time: 1, position: [0, 0, 0], rotate: [0, "
        "0, 0]}, {time: 2, position: [3, 0.1, 0.5], rotate: [10, -40, 5]}]}}\n"
        "water: {bands: [620, 540, 450], absorption: [0.35, 0.08, 0.05], scattering: {b: [0.2, "
        "0.22, 0.25], phase: {type: hg, g: 0.8}}" +
            water +
            "}\n"
            "geometry:\n"
            "  - {type: plane, point: [0, 0, 3], normal: [0.1, 0, -1]}\n"
            "  - type: box\n"
            "    min: [-0.2, -0.3, 1.2]\n"
            "    max: [0.2, 0.3, 1.4]\n"
            "    reflectance: [0.9, 0.6, 0.2]\n"
            "    trajectory: {keyframes: [{time: 0, position: [0, 2, 0], rotate: [0, 0, 0]}, "
            "{time: 2, "
            "position: [0, -2, 0], rotate: [0, 0, 90]}]}\n"
            "lamps:\n"
            "  - {name: own, position: [0.4, -0.3, 0], direction: [0, 0, 1], profile: {type: spot, "
            "beam: 70, edge: 20}, intensity: [40, 40, 40]}\n"
            "  - name: free\n"
            "    frame: world\n"
            "    position: [0, 0, 0]\n"
            "    direction: [0, 0, 1]\n"
            "    profile: {type: isotropic}\n"
            "    intensity: [20, 20, 20]\n"
            "    trajectory: {keyframes: [{time: 0, position: [-2, -0.5, 0.3], rotate: [0, 0, 0]}, "
            "{time: 2, position: [2, -0.5, 0.3], rotate: [0, 0, 0]}]}\n"
            "render: {fps: 10" +
            render + "}\n",
        "scene.yaml");
    if (moves == Moves::camera_alone) {
        scene.geometry[1].trajectory.reset();
        for (LampDesc& lamp : scene.lamps) {
            lamp.trajectory.reset();
            lamp.fixed_to_camera = false;
        }
    }
    return scene_of_image(scene, {k_frame});
}

/// RMS of the difference of some channels over the mean of those expected.
inline double error_of(const Film& film, const std::vector<double>& expected, std::size_t first,
                       std::size_t count) {
    const std::size_t stride = film.channel_names().size();
    double squares = 0, mean = 0;
    std::size_t n = 0;
    for (std::size_t pixel = 0; pixel < film.values().size(); pixel += stride)
        for (std::size_t k = pixel + first; k < pixel + first + count; ++k, ++n) {
            squares += std::pow(static_cast<double>(film.values()[k]) - expected[k], 2);
            mean += expected[k];
        }
    const auto values = static_cast<double>(n);
    return std::sqrt(squares / values) / (mean / values);
}

inline std::vector<double> values_of(const Film& film) {
    return {film.values().begin(), film.values().end()};
}

}  // namespace uw::test
