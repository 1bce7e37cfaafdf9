#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/surfaces.h"
#include "core/light/integrator.h"
#include "core/paths/emission_sampler.h"
#include "core/paths/path_walk.h"

namespace uw {

class IrradianceCache;
struct LampView;
struct ScatteringTables;

/// Estimates all light by random paths from the camera, without bias (docs/multiple.md): the
/// radiance of a camera ray is
///
///     L = int from 0 to D of e^(-tau(s)) sum_m b_m int p_m(w) L(s, w) dw ds
///         + e^(-tau(D)) int f(w) L(D, w) cos dw + what the surface at D emits.
///
/// L(s, w) is the light that arrives from the direction w, and `begin` prepares a density over s.
/// trace_single estimates what has a single event, trace_water and trace_lit_surfaces the rest of
/// the first integral, by whether there is a surface on the way, and trace_surface that of the
/// second one. How a path goes on from its first vertex is PathWalk's. Thread safe.
class PathTracer {
  public:
    /// `deep_shadows`: where paths take optical depths between lamps and points from, one per
    /// emitter: its columns and no others; then those along the paths are coarse, too. Empty: all
    /// columns are exact. `scattering`: of the scene's medium; null: made anew.
    explicit PathTracer(const LitScene& scene,
                        const std::vector<std::shared_ptr<const DeepShadow>>& deep_shadows = {},
                        std::shared_ptr<const ScatteringTables> scattering = nullptr);
    ~PathTracer();
    PathTracer(const PathTracer&) = delete;
    PathTracer& operator=(const PathTracer&) = delete;
    PathTracer(PathTracer&&) = delete;
    PathTracer& operator=(PathTracer&&) = delete;

    /// The tables of the scene's medium.
    const ScatteringTables& scattering() const { return *scattering_; }

    /// Prepares a camera ray, with as many paths of each kind as seem worth it: `hit` is the first
    /// surface along it, null for none; `surface_light` an estimate of that surface's radiance, per
    /// band, that guides the paths; may be empty.
    void begin(const Ray& ray, const SurfaceHit* hit, std::span<const double> surface_light,
               CameraSegment& segment) const;

    /// The light of lamps that the water scatters once, towards the camera.
    void trace_single(CameraSegment& segment, PathRandom& random, ContributionSink& sink) const;

    // Three kinds of paths, as many as CameraSegment::paths says. They return what work it was:
    // roughly the number of vertices at which a direction was chosen by all that is known.

    /// The light that the water scatters towards the camera, of `multiple.volume`, which no surface
    /// has reflected or emitted.
    double trace_water(CameraSegment& segment, PathRandom& random, ContributionSink& sink) const;
    /// And that of surfaces, which the water scatters on its way to the camera.
    double trace_lit_surfaces(CameraSegment& segment, PathRandom& random,
                              ContributionSink& sink) const;
    /// The same. `indirect`: the light on the first of the surfaces that is not direct, by lamp or
    /// all in one; from glossy ones paths go on.
    double trace_lit_surfaces(CameraSegment& segment, const IrradianceCache& indirect,
                              PathRandom& random, ContributionSink& sink) const;
    /// The first surface that such a path meets, and the path's last ray; false if it meets none.
    bool find_lit_surface(CameraSegment& segment, PathRandom& random, SurfaceSample& sample) const;
    /// The light that the segment's surface reflects, other than direct light of lamps, and not
    /// what it emits: `multiple.surface`. Nothing without a surface.
    double trace_surface(CameraSegment& segment, PathRandom& random, ContributionSink& sink) const;
    /// Traces the part of trace_surface's light that was scattered or reflected once, or emitted,
    /// before the sample reflects it. It is the light at the surface itself, not dimmed by the
    /// water in front of it.
    void trace_mirrored(const SurfaceSample& sample, PathRandom& random, ContributionSink& sink,
                        PathScratch& scratch) const;
    /// Whether a contribution of trace_surface is one of trace_mirrored.
    static bool is_mirrored(const PathContribution& contribution) {
        return !contribution.is_met && contribution.scatterings + contribution.reflections ==
                                           (contribution.lamp == k_no_lamp ? 1 : 2);
    }

  private:
    const PathTables& choose_tables(PathRandom& random) const;
    double trace_water_path(CameraSegment& segment, PathRandom& random,
                            ContributionSink& sink) const;
    double trace_lit_surface_path(CameraSegment& segment, const IrradianceCache* indirect,
                                  PathRandom& random, ContributionSink& sink) const;
    void place_intervals(std::span<const LampPassage> passages, CameraSegment& segment) const;
    double expect_surface(CameraSegment& segment, std::span<const double> surface_light,
                          Spectrum& radiance) const;
    void weigh_intervals(std::span<const double> surface_light, CameraSegment& segment) const;

    std::shared_ptr<const ScatteringTables> scattering_;
    EmissionSampler emission_;
    std::vector<LampView> views_;
    std::vector<std::unique_ptr<const PathTables>> tables_;  // one per view
};

}  // namespace uw
