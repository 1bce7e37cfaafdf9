#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/base/ray.h"
#include "core/light/integrator.h"
#include "core/light/lamps_in_view.h"
#include "core/paths/path_segment.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// Estimates the light of lamps that arrives along a segment after a single event: scattered by
/// the water on it, or reflected by the surface at its end. Thread safe.
class NextEventEstimator {
  public:
    /// `deep_shadows`: columns to the lamps, one per lamp; empty: they are exact. `emitters`: the
    /// lamps' numbers among those of the whole scene. The other references must outlive this
    /// object.
    NextEventEstimator(const WaterOptics& optics, const ScatteringTables& tables,
                       std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                       std::vector<std::size_t> emitters);

    /// The water's: int I b p e^-tau / R^2 ds for a lamp chosen by its share, at a point chosen by
    /// its scattering angle psi, in which 1/R^2 and the forward peak are flat: ds / R^2 = dpsi / D
    /// with D the lamp's distance from the line; a sun's at one chosen by its attenuation.
    /// Uses three random numbers.
    void estimate_in_scatter(const WaterSegment& segment, const PathState& state,
                             PathRandom& random, ContributionSink& sink) const;
    /// The surface's, for a lamp chosen by its share, and what it emits; `transmittance` is that of
    /// the segment. Uses one random number. Precondition: segment.has_hit.
    void estimate_direct_light(const WaterSegment& segment, const Spectrum& transmittance,
                               const PathState& state, PathRandom& random,
                               ContributionSink& sink) const;

    /// The columns of the constituents between a lamp and a point [unit m].
    void column_to_lamp(std::size_t lamp, const Point3& x, std::span<double> column) const;

  private:
    const WaterOptics& optics_;
    const ScatteringTables& tables_;
    LampEvenness evenness_;
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows_;
    std::vector<std::size_t> emitters_;
};

}  // namespace uw
