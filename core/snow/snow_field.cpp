#include "core/snow/snow_field.h"

#include <algorithm>
#include <cmath>

#include "core/paths/path_random.h"
#include "core/sensor/random_counts.h"

namespace uw {
namespace {

constexpr std::uint64_t k_stream = 0x736e6f77;  // other numbers than for light paths
// Particles in a cell, on the mean: enough for the cost of a cell to vanish, few enough for cells
// to fill a view closely.
constexpr double k_per_cell = 16;
// The last octave is never much narrower than the others.
constexpr double k_least_ratio = 1.01;

}  // namespace

SnowField::SnowField(const SnowDesc& desc)
    : sizes_(desc.exponent, desc.least, desc.greatest), drift_(desc.drift), seed_(desc.seed) {
    for (double least = desc.least; least < desc.greatest;) {
        double greatest = 2 * least;
        if (greatest * k_least_ratio > desc.greatest) greatest = desc.greatest;
        const double number = desc.number * sizes_.share(least, greatest);
        classes_.push_back({.least = least,
                            .greatest = greatest,
                            .number = number,
                            .mean_area = sizes_.mean_area(least, greatest),
                            .edge = std::cbrt(k_per_cell / number)});
        least = greatest;
    }
}

void SnowField::append_particles(std::size_t index, const SnowCell& cell, double time,
                                 std::vector<SnowParticle>& particles) const {
    const SnowClass& kind = classes_[index];
    std::uint64_t seed = PathRandom::seed_of(k_stream, seed_, index);
    for (const std::int64_t i : cell)
        seed = PathRandom::seed_of(seed, static_cast<std::uint64_t>(i));
    PathRandom of_cell(seed, 0);
    const auto count = static_cast<std::uint64_t>(poisson(k_per_cell, of_cell));
    const Vector3 moved = displacement(time);
    for (std::uint64_t n = 0; n < count; ++n) {
        const std::uint64_t id = PathRandom::seed_of(seed, n + 1);
        PathRandom random(id, 0);
        SnowParticle& particle = particles.emplace_back();
        for (int axis = 0; axis < 3; ++axis)
            particle.position[axis] =
                (static_cast<double>(cell[static_cast<std::size_t>(axis)]) + random.next()) *
                    kind.edge +
                moved[axis];
        particle.diameter = sizes_.quantile(random.next(), kind.least, kind.greatest);
        particle.id = id;
    }
}

}  // namespace uw
