#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/surface_reflection.h"
#include "core/paths/guiding_distribution.h"
#include "core/paths/path_segment.h"
#include "core/paths/resampling.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// Light that a path may meet beyond a vertex, beside that of the lamps: from everywhere, and that
/// of a surface which lies across `normal`, as it arrives [W m^-2 sr^-1].
struct ExpectedAtVertex {
    double ambient = 0, of_surface = 0;
    Vector3 normal{0, 0, 1};
};

/// The direction in which a path goes on from a vertex.
struct DirectionSample {
    Vector3 direction{0, 0, 1};
    Spectrum weight;  // f over the probability density, by which the throughput is to be multiplied
    // Expected from there, mean over the bands with the throughput; without what emissive volumes
    // send without an event on the way.
    double radiance = 0;
    double of_particles = 0;  // MediumRadianceCache's part of it
};

/// Samples the direction in which a path from the camera goes on from a vertex, where the water
/// scatters it or a surface reflects it, by resampled importance sampling (Talbot, Cline and
/// Egbert 2005). Of N candidates w_i with the density p, one is taken in proportion to
/// p^(w_i) / p(w_i), and the integral of f(w) L(w) is estimated by
///
///     f(w) L(w) / p^(w)  *  (1/N) sum_i p^(w_i) / p(w_i).
///
/// f is the sum over m of b_m p_m for a scattering, BRDF times cosine for a reflection. The target
/// p^ is f, summed over the bands with the throughput, times the radiance that is expected from the
/// direction. Half of the candidates are drawn in proportion to f and half in the shape of the
/// light around the lamps (GuidingDistribution); p is the mean of both densities, which is the
/// balance heuristic (Veach 1997). Radiance grows as 1/psi towards a lamp, and without the second
/// kind of candidates the variance would be infinite.
class DirectionSampler {
  public:
    /// Memory that is kept so that paths do not allocate; no two samplers use it at a time.
    struct Scratch {
        /// The response is f, the density N p.
        struct Candidate : ResamplingCandidate {
            Vector3 direction{0, 0, 1};
            double of_particles = 0;  // as in DirectionSample
            double emitted = 0;       // of the radiance: what needs no event on the way
        };

        SurfaceSample surface;
        std::vector<double> phase_cumulative, phase;
        std::vector<Candidate> candidates;
    };

    /// The path that travels along `incoming` is scattered at `x`, where `point` has the scattering
    /// coefficients. `guides` are those at `x`, for the path's `throughput`. All that is referred
    /// to must stay as it is while the sampler is in use.
    DirectionSampler(const GuidingTables& tables, const Point3& x, const Vector3& incoming,
                     const WaterPoint& point, const Spectrum& throughput,
                     const GuidingDistribution& guides, Scratch& scratch);
    /// The path along `ray` is reflected at `hit`.
    DirectionSampler(const GuidingTables& tables, const Ray& ray, const SurfaceHit& hit,
                     const Spectrum& throughput, const GuidingDistribution& guides,
                     Scratch& scratch);

    /// Where the path goes on: at the scattering, or a little above the surface.
    const Point3& origin() const { return origin_; }
    /// Samples a direction, where `expected` is known beside the light of the lamps. Uses five
    /// random numbers; empty where nothing responds.
    std::optional<DirectionSample> sample(PathRandom& random,
                                          const ExpectedAtVertex& expected) const;

  private:
    double sample_candidates(PathRandom& random, const ExpectedAtVertex& expected) const;
    void eval(const Vector3& direction, Spectrum& values) const;
    Vector3 sample_local(double u, double v, double azimuth) const;
    double local_pdf(const Vector3& direction) const;
    double reflected(const Vector3& direction) const;

    const GuidingTables* tables_;
    const GuidingDistribution* guides_;
    Scratch* scratch_;
    Point3 x_, origin_;
    Vector3 incoming_;
    std::span<const Spectrum> scattering_;         // b_m, of a scattering
    std::optional<SurfaceReflection> reflection_;  // of a reflection, by scratch_->surface
    Spectrum throughput_;
};

/// Where a path begins that a surface reflects: a little above it.
Point3 point_above(const SurfaceHit& hit);

/// A direction around `normal` in proportion to its cosine, by two random numbers in [0, 1).
Vector3 cosine_direction(const Vector3& normal, double u, double azimuth);

/// Samples the direction in which a path goes on that is scattered by the phase functions alone,
/// where it travels along `direction`. Multiplies `throughput`, by band, by sum_m b_m p_m over the
/// probability density of what was drawn. Uses three random numbers, and `cumulative` as scratch;
/// empty if nothing scatters.
std::optional<Vector3> sample_phase_function(const ScatteringTables& tables,
                                             const WaterPoint& point, const Vector3& direction,
                                             PathRandom& random, std::span<double> throughput,
                                             std::vector<double>& cumulative);

}  // namespace uw
