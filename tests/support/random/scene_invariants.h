#pragma once

#include <cstdint>

#include "tests/support/random/held_image.h"

namespace uw::test {

/// All light takes longer than that which is scattered once.
enum class Scattered { once, any };

/// hold_image of random_scene of `count` seeds from `first` on; a failure names the seed.
InvariantCounts hold_invariants(std::uint64_t first, int count, Scattered scattered);

}  // namespace uw::test
