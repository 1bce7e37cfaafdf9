// ctest labels: metamorphic
#include <gtest/gtest.h>

#include "tests/support/random/scene_invariants.h"

namespace uw::test {
namespace {

// Scenes take 0.5 s of CPU time each in the mean. tests/render/random/thousands_of_scenes.cpp
// takes 5000, and light that is scattered more than once, too.
TEST(FirstRandomScenes, FulfilWhatEveryImageDoes) {
    hold_about_a_hundred(0);
}

}  // namespace
}  // namespace uw::test
