#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/spectrum.h"
#include "core/base/vector_math.h"
#include "core/light/medium.h"
#include "core/scene/volume_desc.h"

namespace uw {

/// How much light a volume emits, by the value of its grid.
class Emission {
  public:
    /// Throws InputError for a blackbody in a single band, whose width is undefined.
    Emission(const EmissionDesc& desc, std::span<const double> bands_nm);

    /// The light that a cubic metre emits in each direction where the grid has this value, >= 0
    /// [W/(sr m^3)]: proportional to it, by a table, or as a blackbody (Planck's law, over each
    /// band's interval) whose temperature is the value. Below 500 K it emits no visible light.
    Spectrum of(double value) const;

  private:
    std::size_t bands_;
    Spectrum per_unit_;
    std::optional<EmissionDesc::Blackbody> blackbody_;
    std::vector<double> values_;  // of a table
    std::vector<Spectrum> light_;
    std::vector<Spectrum> log_radiance_;  // of a blackbody, at equal steps of 1/T
};

/// A part of an emissive volume, represented by a point light where it lights other things.
struct EmissivePart {
    Point3 centre;       // centroid of its light
    Spectrum intensity;  // in each direction, without water [W/sr]
    double radius = 0;   // of the sphere (LampFrame) whose light has the same variance [m]
};

/// Divides the light that `emission` makes of a field of one constituent, the grid's value, into at
/// most `count` parts of equal power, up to the grain of the cells of which they consist (voxels,
/// or the cells of a lattice of 2^21). Neighbours in the list are neighbours in space.
std::vector<EmissivePart> divide_emission(const ConcentrationField& field, const Emission& emission,
                                          int count);

/// Merges every `count` neighbours in the list into one part.
std::vector<EmissivePart> merged(std::span<const EmissivePart> parts, int count);

/// A volume that emits light.
struct EmissiveVolume {
    std::shared_ptr<const ConcentrationField> field;  // of one constituent: the grid's value
    Emission emission;
    std::vector<EmissivePart> parts;
};

/// An emissive volume that is one of a scene's lamps.
struct SceneEmission {
    std::size_t lamp = 0;  // its index
    std::shared_ptr<const EmissiveVolume> volume;
};

}  // namespace uw
