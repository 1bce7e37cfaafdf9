#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scene/scene_desc.h"
#include "tests/support/scene_folder.h"

namespace uw::test {

/// A scene with one fault, and what the one-line message must say, position and path included.
struct BadScene {
    std::string text;
    std::string expected;
};

class SceneErrors : public ::testing::Test {
  protected:
    SceneErrors() {
        folder_.write("a.vdb", "x");
        folder_.write("sub/a.csv", "x");
    }
    std::string error_of(const std::string& text) {
        try {
            read_scene(folder_.write("scene.yaml", text), {});
        } catch (const InputError& error) {
            return error.what();
        }
        return "no InputError";
    }
    /// Each case is `before` + its text.
    void check(const std::string& before, const std::vector<BadScene>& cases) {
        for (const BadScene& bad : cases) {
            const std::string found = error_of(before + bad.text);
            EXPECT_NE(found.find(bad.expected), std::string::npos)
                << bad.text << "\n  gave:     " << found << "\n  expected: " << bad.expected;
            EXPECT_EQ(found.find('\n'), std::string::npos) << "one line: " << found;
        }
    }
    SceneFolder folder_;
};

/// A scene that is complete but for what a case appends.
inline constexpr auto k_base =
    "uwvdb: 1\ncamera: {resolution: [64, 48], intrinsics: {fov_x: 60}}\n";

}  // namespace uw::test
