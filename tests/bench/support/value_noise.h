#pragma once

#include <cstdint>

#include "core/base/vector_math.h"

namespace uw::bench {

/// A number in [0, 1) that depends only on the three arguments, on every machine.
double hashed(std::int32_t i, std::int32_t j, std::int32_t k);

/// Smooth noise in [0, 1): the hashed numbers of the integer lattice, interpolated, in `octaves` of
/// doubled frequency and halved weight.
double value_noise(const Vector3& x, int octaves);

}  // namespace uw::bench
