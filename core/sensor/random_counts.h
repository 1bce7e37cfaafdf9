#pragma once

#include "core/paths/path_random.h"

namespace uw {

/// A number of Poisson's distribution with this mean, whole and >= 0: the distribution itself, not
/// a normal one in its place. Inversion below a mean of 30, above it the rejection method PTRS
/// (Hörmann 1993, "The transformed rejection method for generating Poisson random variables").
double poisson(double mean, PathRandom& random);

/// Two independent numbers of the normal distribution with mean 0 and variance 1 (Box and Muller
/// 1958).
struct NormalPair {
    double first, second;
};
NormalPair standard_normals(PathRandom& random);

}  // namespace uw
