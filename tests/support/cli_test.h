#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/image_file.h"
#include "tests/support/run_program.h"
#include "tests/support/temp_dir.h"

namespace uw::test {

/// A small lit scene: hazy water, a wall at z = 4 and a box in front of it, a lamp beside the
/// camera.
inline constexpr const char* k_small_scene = R"(uwvdb: 1
camera:
  resolution: [33, 19]
  intrinsics: {fov_x: 60}
  pose: {position: [0, 0, 0], look_at: [0, 0, 1], up: [0, -1, 0]}
water:
  bands: [620, 540, 450]
  absorption: [0.35, 0.08, 0.05]
  scattering: {b: [0.20, 0.22, 0.25], phase: {type: hg, g: 0.8}}
geometry:
  - {type: plane, point: [0, 0, 4], normal: [0, 0, -1]}
  - {type: box, min: [0.2, -0.3, 1.5], max: [0.6, 0.2, 1.9], reflectance: [0.7, 0.4, 0.2]}
lamps:
  - {name: left, position: [-0.5, -0.2, 0], direction: [0.1, 0, 1], profile: {type: spot, beam: 80, edge: 20}, intensity: [50, 40, 30]}
)";

/// Runs the program in a folder of its own, in which "scene.yaml" is `k_small_scene`.
class CliTest : public testing::Test {
  protected:
    CliTest() { write("scene.yaml", k_small_scene); }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    std::string read(const std::string& name) const {
        std::ifstream in(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
    std::size_t file_count() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
    }

    ProgramResult run(const std::vector<std::string>& arguments, int terminal_columns = 0) const {
        return run_program(arguments,
                           {.folder = folder_.path(), .terminal_columns = terminal_columns});
    }

    /// Renders scene.yaml to out.exr with the further arguments, and with all layers unless they
    /// say which; the run must succeed.
    ImageFile render(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"render", "scene.yaml", "-o", "out.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        if (std::ranges::find(more, "--layers") == more.end())
            arguments.insert(arguments.end(), {"--layers", "all"});
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_exr(folder_ / "out.exr");
    }

    /// A run that must end with `exit_code` and one line that contains `part`, on stderr alone.
    void expect_failure(const std::vector<std::string>& arguments, int exit_code,
                        const std::string& part) const {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(line_count(result.err), 1) << result.err;
        EXPECT_TRUE(result.err.starts_with("uwvdb: ")) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    }

    TempDir folder_;
};

/// Expects that no value is NaN or infinite, and that none of R, G, B is entirely black.
inline void expect_finite_and_lit(const ImageFile& image) {
    for (const auto& [name, values] : image.channels)
        for (const float value : values) ASSERT_TRUE(std::isfinite(value)) << name;
    for (const char* name : {"R", "G", "B"}) {
        float largest = 0;
        for (const float value : image.channels.at(name)) largest = std::max(largest, value);
        EXPECT_GT(largest, 0) << name;
    }
}

}  // namespace uw::test
