#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec.h"
#include "core/scene/snow_desc.h"
#include "core/snow/junge_sizes.h"

namespace uw {

/// One particle of snow.
struct SnowParticle {
    Point3 position;      // world, at the time asked for
    double diameter = 0;  // [m]
    std::uint64_t id =
        0;  // the same at all times; different for different particles, almost surely
};

/// Particles whose diameters lie within a factor of two.
struct SnowClass {
    double least = 0, greatest = 0;  // diameters [m]
    double number = 0;               // per m^3
    double mean_area = 0;            // cross section [m^2]
    double edge = 0;                 // of the cells that they are placed in [m]

    /// The share of light that they take away per metre: all that meets their cross section.
    double attenuation() const { return number * mean_area; }
};

/// The cell of a class with these indices: particles' positions at time 0 are from index * edge to
/// (index + 1) * edge along each axis.
using SnowCell = std::array<std::int64_t, 3>;

/// All the snow of an unbounded ocean. Nothing of it is stored: the particles of a cell, their
/// number (Poisson's), places (uniform) and diameters (Junge's) follow from the seed and the cell
/// alone, and all drift together, so that they are the same for every camera and frame.
class SnowField {
  public:
    explicit SnowField(const SnowDesc& desc);

    const std::vector<SnowClass>& classes() const { return classes_; }
    /// How far all particles have moved since time 0 [m].
    Vector3 displacement(double time) const { return time * drift_; }

    /// Appends the particles of a cell of class `index` at a time [s].
    void append_particles(std::size_t index, const SnowCell& cell, double time,
                          std::vector<SnowParticle>& particles) const;

  private:
    JungeSizes sizes_;
    std::vector<SnowClass> classes_;
    Vector3 drift_;
    std::uint64_t seed_;
};

}  // namespace uw
