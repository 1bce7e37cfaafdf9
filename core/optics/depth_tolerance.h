#pragma once

#include <span>
#include <vector>

#include "core/optics/medium.h"

namespace uw {

/// How far columns may be from the truth, in terms of the light that passes them: an error counts
/// as the optical depth that it amounts to in the band that attenuates most, times a bound on the
/// transmittance of the path that leads there. What lies behind much optical depth, or changes
/// little, may thus be coarse.
class DepthTolerance {
  public:
    /// None: as exact as voxels allow.
    DepthTolerance() = default;
    /// `optical_depth`: the greatest error of one step of an integration or interpolation.
    DepthTolerance(const Medium& medium, double optical_depth);

    bool exact() const { return optical_depth_ == 0; }

    /// Whether `error` [unit m], one per constituent, is within the tolerance behind the columns
    /// `before` and `length` metres of water.
    bool allows(std::span<const double> error, double length, std::span<const double> before) const;

    /// An optical depth that no band falls short of.
    double least_depth(double length, std::span<const double> columns) const;

    friend bool operator==(const DepthTolerance&, const DepthTolerance&) = default;

  private:
    double optical_depth_ = 0;
    double least_uniform_ = 0;                            // over the bands [1/m]
    std::vector<double> least_per_unit_, most_per_unit_;  // per constituent [1/m per unit]
};

}  // namespace uw
