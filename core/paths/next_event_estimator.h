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

/// Next-event estimation: estimates the light of lamps that arrives along a segment after a single
/// event, in-scattered by the water on the segment or reflected by the surface at its end. Thread
/// safe.
class NextEventEstimator {
  public:
    /// `deep_shadows`: tabulated columns to the lamps, one per lamp; if empty, columns are exact.
    /// `emitters`: the lamps' indices among the emitters of the whole scene. What is referred to
    /// must outlive this object.
    NextEventEstimator(const WaterOptics& optics, const ScatteringTables& tables,
                       std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                       std::vector<std::size_t> emitters);

    /// Estimates the in-scattered light of one lamp, chosen in proportion to its expected
    /// contribution,
    ///
    ///     int I b p e^-tau / R^2 ds,
    ///
    /// by equiangular sampling (Kulla and Fajardo 2012): with the scattering angle psi and the
    /// lamp's distance D from the line, ds / R^2 = dpsi / D. Sampling psi in proportion to the
    /// phase functions makes the forward peak constant, too. For a sun, distances are sampled by
    /// transmittance. Uses three random numbers.
    void estimate_in_scatter(const WaterSegment& segment, const PathState& state,
                             PathRandom& random, ContributionSink& sink) const;
    /// Estimates the light of one lamp, chosen in proportion to its expected contribution, that the
    /// surface at the end reflects, and adds what the surface emits. `transmittance`: that of the
    /// segment. Uses one random number. Precondition: segment.has_hit.
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
