#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/base/ray.h"
#include "core/light/integrator.h"
#include "core/paths/path_segment.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// Estimates the light of lamps that arrives along a segment after a single event: scattered by
/// the water on it, or reflected by the surface at its end. Thread safe.
class LampGathering {
  public:
    /// `deep_shadows`: columns to the lamps, one per lamp; empty: they are exact. The other
    /// references must outlive this object.
    LampGathering(const WaterOptics& optics, const ScatteringTables& tables,
                  std::vector<std::shared_ptr<const DeepShadow>> deep_shadows);

    /// The water's: int I b p e^-tau / R^2 ds for a lamp chosen by its share, at a point chosen by
    /// its scattering angle psi, in which 1/R^2 and the forward peak are flat: ds / R^2 = dpsi / D
    /// with D the lamp's distance from the line; a sun's at one chosen by its attenuation.
    /// Uses three random numbers. `weights`: a factor for
    /// each lamp, or none; lamps whose factor is 0 are not chosen.
    void gather_from_water(const WaterSegment& segment, std::span<const double> weights,
                           const PathState& state, PathRandom& random, PathTerms& terms) const;
    /// The surface's, for a lamp chosen by its share; `transmittance` is that of the segment. Uses
    /// one random number. Returns what would arrive of it, and of what the surface emits, through
    /// clear water, roughly: the mean of the bands [W m^-2 sr^-1]. Precondition: segment.has_hit.
    double gather_from_surface(const WaterSegment& segment, const Spectrum& transmittance,
                               const PathState& state, PathRandom& random, PathTerms& terms) const;

  private:
    void column_to_lamp(std::size_t lamp, const Point3& x, std::span<double> column) const;

    const WaterOptics& optics_;
    const ScatteringTables& tables_;
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows_;
};

}  // namespace uw
