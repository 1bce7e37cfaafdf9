#pragma once

#include <optional>
#include <vector>

#include "core/base/random.h"
#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/light/ray_panels.h"
#include "core/paths/direction_sampler.h"
#include "core/paths/next_event_estimator.h"
#include "core/paths/path_segment.h"
#include "core/paths/path_tables.h"

namespace uw {

class IrradianceCache;

/// The fraction of the ambient light that a path is expected to find beyond what is known of it.
inline constexpr double k_ambient_beyond = 0.02;

/// The water ahead of a path: from its last vertex to the first surface in its direction.
struct PathSegment {
    WaterSegment water;
    Spectrum transmittance;      // of all of it; 0 without a surface at its end
    GuidingDistribution guides;  // the light of the lamps around its beginning
    /// What the surface at its end is expected to reflect, mean over the bands, and what that
    /// contributes to the pixel, summed over the bands.
    double surface_radiance = 0, surface_contribution = 0;
};

/// Memory that is kept so that paths do not allocate. Each path writes whatever it reads; no two
/// paths use it at a time.
struct PathScratch {
    /// Where a path may be scattered next on its segment.
    struct Collision : ResamplingCandidate {  // the response is b [1/m]
        double distance = 0;
    };

    PathSegment segment;
    WaterPoint point;
    DirectionSampler::Scratch directions;
    std::vector<Collision> collisions;
    std::vector<PathState> branches;  // that have yet to be followed
    GuidingDistribution guides_in_mirror;
    std::vector<double> cumulative, indirect, column;
    NextEventScratch next_event;
    EmissionSampler::Scratch emission;
    WaterSegment towards_emission;
    // For preparing a camera ray, beside the point:
    std::vector<LampPassage> passages;  // of the lamps
    std::vector<double> guided, plain;
    GuidingDistribution guides;
};

/// A camera ray in the water up to the first surface, prepared for many paths (PathTracer::begin).
/// Its storage is reused. No two paths of a segment are traced at a time, since they work in it.
struct CameraSegment {
    WaterSegment water;
    Spectrum transmittance;  // up to the surface; not set without one
    /// Where the paths' first scattering lies: running sums of weights of the intervals between
    /// `distances`, in each of which it is uniform. Empty where the water scatters no light.
    std::vector<double> distances, cumulative;
    ExpectedLight expected;
    /// The mean numbers of paths of each kind that are traced in place of one: fewer where they
    /// bring less of the ray's light than others.
    PathCounts paths;
    PathScratch scratch;

    /// As many times the paths of each kind as `times` says, within limits.
    void multiply_paths(const PathCounts& times);
};

/// Traces a light path from its first vertex, and all branches into which it splits. With the
/// throughput T_k of its segment k, the path estimates the pixel's radiance by
///
///     sum over k of T_k N_k,    T_(k+1) = T_k / q_k * e^(-tau(s)) / p(s) * f(w) / p(w).
///
/// N_k is the light of lamps that arrives along the segment after a single event, by next-event
/// estimation (NextEventEstimator); w the direction, sampled by resampled importance sampling of
/// the phase function or BRDF times the expected light (DirectionSampler); s the distance of the
/// next vertex (sample_vertex). q is the splitting factor of adjoint-driven Russian roulette and
/// splitting (Vorba and Krivanek 2016): the expected contribution of what lies ahead over the
/// pixel's own radiance. On average q branches go on, fewer than one included. If the throughput
/// alone decided, as in plain roulette, rare paths would be far too bright.
class PathWalk {
  public:
    PathWalk(const PathTables& tables, PathRandom& random, ContributionSink& sink,
             PathScratch& scratch)
        : tables_(tables), random_(random), sink_(sink), scratch_(scratch) {}

    /// The work so far: vertices at which a direction was sampled by all that is known, and a
    /// fraction of each other.
    double work() const { return work_; }

    /// Follows a path that is scattered at `point` of `segment`.
    void trace_from_water(PathState state, const WaterSegment& segment, const WaterPoint& point);
    /// Follows a path that `surface` reflects. Its splitting is relative to what that is expected
    /// to reflect.
    void trace_from_surface(PathState state, const SurfaceSample& surface);
    /// Adds what `surface` reflects of light that was scattered or reflected once before, and no
    /// more.
    void trace_mirrored(PathState state, const SurfaceSample& surface);

    /// Follows an analog random walk from `segment`: the path is scattered on it, and on by the
    /// phase function alone until it meets a surface. Returns the segment that ends there, which
    /// is valid until the next path, or null if there is none. `state` is that at the surface, its
    /// throughput with the transmittance.
    const WaterSegment* walk_to_surface(PathState& state, const WaterSegment& segment);
    /// Adds the light of the surface at which such a walk has ended, and follows the path on from
    /// there.
    void trace_lit_surface(PathState state, const WaterSegment& segment);
    /// The same, but looks up what is not direct; the path goes on from glossy surfaces only.
    void trace_lit_surface(PathState state, const WaterSegment& segment,
                           const IrradianceCache& indirect);

  private:
    void trace_branches(PathState state, PathSegment& segment,
                        std::optional<DirectionSampler> vertex);

    // Samples the direction from a vertex; the state is that of the path along it, or the function
    // returns nothing where the path ends.
    std::optional<DirectionSample> sample_direction(const DirectionSampler& vertex,
                                                    PathState& state);
    ExpectedAtVertex expected_around(const Point3& x, const PathState& state) const;
    double splitting_factor(const PathState& state, const PathSegment& segment,
                            const DirectionSample& direction) const;

    // Samples the distance of the next vertex and adds it to the path; nothing if the path ends.
    std::optional<DirectionSampler> sample_vertex(PathState& state, PathSegment& segment);
    double sample_collisions(const PathState& state, const PathSegment& segment,
                             std::vector<PathScratch::Collision>& collisions);
    DirectionSampler add_scattering(PathState& state, const Ray& ray, const WaterPoint& point,
                                    GuidingDistribution& guides);
    DirectionSampler add_reflection(PathState& state, const Ray& ray, const SurfaceHit& hit,
                                    GuidingDistribution& guides);
    void add_vertex(PathState& state, PathVertex::Kind kind, const Point3& position,
                    const SurfaceHit* hit = nullptr);

    // Fills the segment along the state's ray, but for its guides and what is expected of it.
    void trace_segment(const PathState& state, PathSegment& segment);
    Spectrum transmittance(const WaterSegment& segment);
    // Goes on along the segment that begins where a specular surface mirrors or refracts the path,
    // of which `factor` is left before it; false where the path ends.
    bool follow_specular(PathState& state, PathSegment& segment, Spectrum factor);
    // Samples how a path with this throughput goes on from the specular surface at the segment's
    // end, and multiplies `factor` by what is left of its light; nothing where it ends.
    std::optional<Ray> sample_specular(const WaterSegment& segment, const Spectrum& throughput,
                                       Spectrum& factor);
    Ray mirrored_ray(const WaterSegment& segment) const;
    double water_surface_reflectance(const WaterSegment& segment) const;

    void estimate_next_event(PathState& state, const PathSegment& segment);
    void add_surface_light(PathState& state, const WaterSegment& segment,
                           const Spectrum& transmittance);
    // Adds the light of emissive volumes that the surface at the segment's end reflects.
    void add_reflected_emission(PathState state, const WaterSegment& segment,
                                const Spectrum& transmittance);
    // Sets what is expected of the surface at the segment's end.
    void expect_surface(const PathState& state, PathSegment& segment);
    // What is expected of a specular surface at the segment's end.
    double expected_from_specular(const PathState& state, const WaterSegment& segment,
                                  const Spectrum& throughput);
    // What is expected to arrive along the ray by which a specular surface is left.
    double expected_in_mirror(const PathState& state, const Ray& mirrored,
                              const Spectrum& throughput);

    // Steps of the random walk. The weights are those of the bands, over what they lose together.
    double sample_free_flight(const WaterSegment& segment, const Spectrum& weights,
                              const Spectrum& transmittance, double u) const;
    bool collide(PathState& state, const WaterSegment& segment, const Spectrum& weights,
                 double distance, WaterPoint& point) const;
    bool meets_surface_before(double distance, const Spectrum& weights, PathState& state,
                              WaterSegment& segment);

    const PathTables& tables_;
    PathRandom& random_;
    ContributionSink& sink_;
    PathScratch& scratch_;
    double work_ = 0;
};

}  // namespace uw
