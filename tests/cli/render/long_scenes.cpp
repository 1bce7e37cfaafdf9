// ctest labels: golden slow
// The example scenes that take longest; all others are in example_scenes.cpp.
#include <gtest/gtest.h>

#include <string_view>

#include "tests/support/example_scenes.h"

namespace uw {
namespace {

using LongScenes = test::ExampleScenes;

TEST_F(LongScenes, RenderAsTheyAre) {
    for (const std::string_view scene : test::k_long_scenes) expect_renders(scenes_ / scene);
}

}  // namespace
}  // namespace uw
