#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/surface_reflection.h"
#include "core/paths/guiding_distribution.h"
#include "core/paths/path_segment.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// One of several directions that are drawn at a sampler, of which a path takes one.
struct DirectionCandidate {
    Vector3 direction{0, 0, 1};
    double light = 0;  // guessed to arrive from there, mean over the bands with the throughput
    double of_particles = 0;  // MediumRadianceCache's part of it
    double response = 0;      // the sampler to it, roughly, summed over the bands
    double density = 0;       // with which any of the candidates is drawn there, times their number
    double weight() const { return response * light / density; }
};

/// Light that paths may meet beside that of the lamps: from everywhere, and that of a surface which
/// lies across `normal`, as it arrives [W m^-2 sr^-1].
struct ExpectedRadiance {
    double ambient = 0, of_surface = 0;
    Vector3 normal{0, 0, 1};
};

/// The direction in which a path goes on that is scattered by the phase functions alone, where it
/// travels along `direction`. Multiplies `throughput`, by band, by the scattering coefficients over
/// the probability of what was drawn. Uses three random numbers; empty if nothing scatters.
std::optional<Vector3> sample_phase_function(const ScatteringTables& tables,
                                             const WaterPoint& point, const Vector3& direction,
                                             PathRandom& random, std::span<double> throughput);

/// Where a path from the camera turns: scattered by the water or reflected by a surface. It draws a
/// few candidates of the direction in which the path goes on, of two kinds: in proportion to its
/// own phase function or BRDF, and in the shape of the light around the lamps, as
/// GuidingDistribution know it. Radiance grows as 1/psi towards a lamp: without the second kind the
/// variance would be infinite. Reused storage.
class DirectionSampler {
  public:
    /// The path travels along `direction` and is scattered at `x`; `point` has the scattering
    /// coefficients there and must stay valid. `throughput` weighs the bands.
    void scatter(const GuidingTables& tables, const Point3& x, const Vector3& direction,
                 const WaterPoint& point, const Spectrum& throughput);
    /// The path of `segment`, which must stay valid, is reflected by the surface at its end.
    void reflect(const GuidingTables& tables, const WaterSegment& segment,
                 const Spectrum& throughput);

    /// Draws candidates, of which `expected` is known beside the lamps. Their weights, in
    /// proportion to which one of them is to be chosen, sum to the number that is returned. Uses
    /// four random numbers.
    double sample_candidates(PathRandom& random, const ExpectedRadiance& expected,
                             std::vector<DirectionCandidate>& candidates) const;
    const GuidingDistribution& guides() const { return guides_; }

    /// sum_m b_m p_m, or BRDF times cosine, towards `direction` [1/m/sr, 1/sr].
    void eval(const Vector3& direction, Spectrum& values) const;

  private:
    void find_guides(const Spectrum& throughput);
    Vector3 sample_local(double u, double v, double azimuth) const;
    double local_pdf(const Vector3& direction) const;
    double guide_pdf(const Vector3& direction) const;
    double target_density(const Vector3& direction) const;

    const GuidingTables* tables_ = nullptr;
    Point3 x_;
    Vector3 incoming_{0, 0, 1};              // of the path, away from the camera
    const WaterPoint* point_ = nullptr;      // of a scattering
    const WaterSegment* segment_ = nullptr;  // of a reflection
    std::optional<SurfaceSample> sample_;
    std::optional<SurfaceReflection> reflection_;
    std::vector<double> phase_cumulative_;
    GuidingDistribution guides_;
    std::vector<double> guide_cumulative_;
    Spectrum throughput_;
};

}  // namespace uw
