#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/support/cli_test.h"

namespace uw::test {

/// The water and the surfaces of the small scene.
inline std::string small_world() {
    const std::string scene = k_small_scene;
    const std::size_t begin = scene.find("water:");
    return scene.substr(begin, scene.find("lamps:") - begin);
}

/// The small scene with a camera that moves straight for a second and turns, seven frames.
inline const std::string k_moving_scene = R"(uwvdb: 1
camera:
  resolution: [40, 30]
  intrinsics: {fx: 36, fy: 35, cx: 19, cy: 15.5}
  trajectory:
    keyframes:
      - {time: 0, position: [0, 0, 0], look_at: [0, 0, 4], up: [0, -1, 0]}
      - {time: 1, position: [0.5, 0.1, 0.2], look_at: [0.1, 0, 4], up: [0, -1, 0]}
)" + small_world() + R"(lamps:
  - {name: left, position: [-0.5, -0.2, 0], intensity: [50, 40, 30]}
render: {fps: 6, samples: 1}
)";

/// A rectified pair, 10 cm apart, before the same wall and box.
inline const std::string k_pair_scene = R"(uwvdb: 1
rig: {pose: {position: [0, 0, 0], look_at: [0, 0, 1], up: [0, -1, 0]}}
cameras:
  - {name: left, resolution: [40, 30], intrinsics: {fx: 36, fy: 35, cx: 19, cy: 15.5},
     pose: {position: [0, 0, 0], look_at: [0, 0, 1], up: [0, -1, 0]}}
  - {name: right, resolution: [40, 30], intrinsics: {fx: 36, fy: 35, cx: 18, cy: 15.5},
     pose: {position: [0.1, 0, 0], look_at: [0.1, 0, 1], up: [0, -1, 0]}}
)" + small_world() + R"(lamps:
  - {name: left, position: [-0.5, -0.2, 0], intensity: [50, 40, 30]}
render: {samples: 1}
)";

/// Runs `uwvdb dataset` on moving.yaml and pair.yaml, these two.
class DatasetTest : public CliTest {
  protected:
    DatasetTest() {
        write("moving.yaml", k_moving_scene);
        write("pair.yaml", k_pair_scene);
    }

    /// Makes the folder "set" of a scene in these formats.
    void make(const std::string& scene, const std::string& formats,
              const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"dataset",  scene,   "-o",     "set",
                                           "--format", formats, "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
    }
    /// What OpenImageIO reads of a frame's EXR.
    ImageFile truth(const std::string& stem) const {
        return read_exr(folder_ / ("set/exr/" + stem + ".exr"));
    }
};

}  // namespace uw::test
