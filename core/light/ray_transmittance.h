#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/light/medium.h"

namespace uw {

/// The attenuation coefficients of what a medium's constituents add to its uniform water.
AttenuationTable attenuation_of_constituents(const Medium& medium);

/// The transmittance of the water along one ray, from its origin to any distance: the
/// concentrations are linear between the knots of their profile, so that columns are exact there.
class RayTransmittance {
  public:
    /// Finds the columns of `field` along `ray` up to `end` [m, > 0]. `attenuation`, which must
    /// outlive this object, says what counts: all water, or its constituents alone.
    RayTransmittance(const AttenuationTable& attenuation, const ConcentrationField& field,
                     const Ray& ray, double end);

    double end() const { return profile_.s.back(); }
    /// tau of each band from the origin to the distance `s`, 0 to end().
    Spectrum optical_depth(double s) const;
    /// The mean of e^-tau over the bands, a single number for how much is seen through the water.
    double mean_transmittance(double s) const;
    /// The least distance at which that mean has fallen to `transmittance`, 0 to 1 [m]; none if it
    /// is greater up to the end.
    std::optional<double> distance_at(double transmittance) const;

  private:
    // The same at `s`, which lies between this knot and the next.
    Spectrum optical_depth(std::size_t knot, double s) const;
    double mean_transmittance(std::size_t knot, double s) const;

    const AttenuationTable& attenuation_;
    ConcentrationProfile profile_;
};

}  // namespace uw
