// ctest labels: metamorphic
#include <gtest/gtest.h>

#include "tests/support/random/scene_invariants.h"

namespace uw::test {
namespace {

// As first_hundred.cpp, beside which it runs.
TEST(SecondRandomScenes, FulfilWhatEveryImageDoes) {
    hold_about_a_hundred(126);
}

}  // namespace
}  // namespace uw::test
