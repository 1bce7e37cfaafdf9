// ctest labels: statistical slow
// Marine snow of which only the brightest particles are drawn (docs/snow.md).
#include <gtest/gtest.h>

#include "tests/support/snow/thick_snow.h"

namespace uw::test {
namespace {

/// Few particles are drawn; the others are their mean.
TEST(UndrawnParticles, ParticlesNotDrawnAreTheirMean) {
    SceneDesc desc = thick_scene(), without = desc;
    desc.water.snow->most = 300;
    without.water.snow.reset();
    expect_mean(desc, without);
}

}  // namespace
}  // namespace uw::test
