#pragma once

#include <cstdint>

#include "tests/support/random/held_image.h"

namespace uw::test {

/// All light takes longer than that which is scattered once.
enum class Scattered { once, any };

/// hold_image of random_scene of `count` seeds from `first` on; a failure names the seed.
InvariantCounts hold_invariants(std::uint64_t first, int count, Scattered scattered);

/// hold_invariants of a hundred scenes of single scattering or so, from the seed `first` on, whose
/// number, refusals and comparisons are expected, and printed.
void hold_about_a_hundred(int first);

}  // namespace uw::test
