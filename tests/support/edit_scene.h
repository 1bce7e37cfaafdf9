#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>

namespace uw::test {

/// Two lamps over a wall, small enough to be rendered in a blink.
inline constexpr const char* k_edit_scene = R"(# A rig.
uwvdb: 1
camera:
  resolution: [96, 64]
  intrinsics: {fx: 70, fy: 70, cx: 48, cy: 32}
  port: {type: flat, distance: 0.02, thickness: 0.02}
water:
  bands: [620, 540, 450]
  preset: jerlov-II
geometry:
  - {type: plane, point: [0, 0, 3], normal: [0, 0, -1], reflectance: [0.5, 0.5, 0.5]}
  - {type: box, min: [-0.3, -0.3, 2], max: [0.3, 0.3, 2.4]}
lamps:
  - name: left  # port side
    position: [-0.5, 0, 0.6]
    direction: [0.2, 0, 1]
    profile: {type: spot, beam: 60, edge: 10}
    intensity: [40, 30, 20]
  - name: right
    position: [0.5, 0, 0.6]
    direction: [-0.2, 0, 1]
    intensity: [10, 10, 10]
render:
  samples: 1
)";

/// Waits until `holds`, at most `seconds`; whether it does.
inline bool eventually(const std::function<bool()>& holds, double seconds = 600) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!holds()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

}  // namespace uw::test
