#pragma once

#include <cstdint>
#include <string_view>

namespace uw {

/// The random numbers of one path: the points of an extensible rank-1 lattice (Cools, Kuo and
/// Nuyens 2006), shifted at random, in the first dimensions and independent numbers in the others.
/// Counter-based: a number depends on (seed, index, dimension) alone, so that images depend neither
/// on the number of threads nor on the order of their pixels.
///
/// Paths of one `seed` and indices 0..2^k - 1 cover the unit cube evenly: their mean has less
/// variance than that of independent paths, but gives no estimate of its own error. Means for
/// different seeds are independent.
class PathRandom {
  public:
    PathRandom(std::uint64_t seed, std::uint32_t index);

    /// The number of the next dimension, in [0, 1).
    double next();
    /// Continues with dimension `dimension`, so that what precedes may use any number of them.
    void skip_to(int dimension) { dimension_ = dimension; }

    /// A seed for each combination of the arguments.
    static std::uint64_t seed_of(std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0);

  private:
    std::uint64_t seed_;
    std::uint64_t stream_;  // of the numbers beyond the lattice
    std::uint32_t point_;   // of the van der Corput sequence, in units of 2^-32
    int dimension_ = 0;
};

/// The random number, uniform in (0, 1), for the key `key` (in a list, for its `component`th entry)
/// in the variation `variation`. It depends on these and the seed alone, so that other keys and
/// other variations do not change it.
double draw_random(std::uint64_t seed, std::string_view key, std::size_t component, int variation);

/// Draws from the Poisson distribution with this mean, exactly rather than by a normal
/// approximation. Inversion below a mean of 30, above it the rejection method PTRS (Hörmann 1993,
/// "The transformed rejection method for generating Poisson random variables").
double poisson(double mean, PathRandom& random);

/// Draws two independent standard normal numbers (Box and Muller 1958).
struct NormalPair {
    double first, second;
};
NormalPair standard_normals(PathRandom& random);
}  // namespace uw
