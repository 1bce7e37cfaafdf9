#pragma once

#include <random>

#include "core/base/vector_math.h"

namespace uw::test {

/// A unit vector, uniformly distributed over the sphere.
inline Vector3 random_direction(std::mt19937& rng) {
    std::normal_distribution<double> normal;
    return glm::normalize(Vector3(normal(rng), normal(rng), normal(rng)));
}

}  // namespace uw::test
