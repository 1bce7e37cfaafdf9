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

/// The light that a volume gives off where its grid has a value.
class Emission {
  public:
    /// Throws InputError for a blackbody in a single band, whose width is undefined.
    Emission(const EmissionDesc& desc, std::span<const double> bands_nm);

    /// What a cubic metre shines in each direction where the grid has this value, >= 0
    /// [W/(sr m^3)]: in proportion to it, by a table, or as a blackbody (Planck's law, over each
    /// band's interval) whose temperature the value is. Below 500 K there is no light to be seen.
    Spectrum of(double value) const;

  private:
    std::size_t bands_;
    Spectrum per_unit_;
    std::optional<EmissionDesc::Blackbody> blackbody_;
    std::vector<double> values_;  // of a table
    std::vector<Spectrum> light_;
    std::vector<Spectrum> log_radiance_;  // of a blackbody, at equal steps of 1/T
};

/// A part of a volume that glows: what stands for it where it lights others.
struct EmissivePart {
    Point3 centre;       // of its light
    Spectrum intensity;  // in each direction, without water [W/sr]
    double radius = 0;   // of the sphere (LampFrame) whose light lies as far from its centre [m]
};

/// The parts of all light that `emission` makes of a field of one constituent, the grid's value: at
/// most `count`, of the same light each but for the grain of the cells (the voxels, or those of a
/// lattice of 2^21) that they consist of. Neighbours in the list are neighbours in space.
std::vector<EmissivePart> divide_emission(const ConcentrationField& field, const Emission& emission,
                                          int count);

/// Every `count` neighbours in the list as one.
std::vector<EmissivePart> merged(std::span<const EmissivePart> parts, int count);

/// A volume that gives off light.
struct EmissiveVolume {
    std::shared_ptr<const ConcentrationField> field;  // of one constituent: the grid's value
    Emission emission;
    std::vector<EmissivePart> parts;
};

/// The same as a lamp of a scene.
struct SceneEmission {
    std::size_t lamp = 0;  // its index
    std::shared_ptr<const EmissiveVolume> volume;
};

}  // namespace uw
