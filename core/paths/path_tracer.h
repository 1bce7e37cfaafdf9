#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/surfaces.h"
#include "core/light/integrator.h"
#include "core/light/lamp.h"
#include "core/paths/lamp_gathering.h"
#include "core/paths/path_segment.h"
#include "core/paths/path_vertex.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// A scene's lamps as a light path sees them: each as one point, whatever its extent. The mean over
/// all views is the light of the lamps, so that a path that chooses one at random costs what it
/// does among point lamps.
struct LampView {
    std::vector<Lamp> lamps;            // one per lamp
    std::vector<std::size_t> emitters;  // which of the scene's each of them is
};

/// As many views as the lamp with most emitters has, and one without lamps. `emitters`: as
/// LitScene::emitters.
std::vector<LampView> lamp_views(const std::vector<Lamp>& emitters);

/// What all paths through a scene look up that see its lamps alike (LampView).
struct PathTables {
    WaterOptics optics;
    const ScatteringTables& scattering;
    LampGathering lamps;
    LampGlow glow;
    VertexTables vertices;
    Spectrum light;   // of all lamps on their axes, or 1 without lamps
    Spectrum albedo;  // the greatest of all the water may hold, at least 0.1: guides paths

    /// `scene`: with one emitter per lamp. `deep_shadows`: as LampGathering takes them. What is
    /// referred to must outlive this object.
    PathTables(const LitScene& scene, const ScatteringTables& tables,
               std::vector<std::shared_ptr<const DeepShadow>> deep_shadows)
        : optics(scene),
          scattering(tables),
          lamps(optics, scattering, std::move(deep_shadows)),
          glow(optics, scattering),
          vertices{&optics, &scattering, &glow} {
        for (const Lamp& lamp : *scene.emitters) light += lamp.axis_intensity();
        for (std::size_t b = 0; b < optics.bands(); ++b) {
            const auto include = [&](const OpticalCoefficients& coefficients) {
                const double c = coefficients.attenuation(b);
                if (c > 0) albedo[b] = std::max(albedo[b], coefficients.total_scattering()[b] / c);
            };
            include(scene.medium->uniform);
            for (const Constituent& constituent : scene.medium->constituents)
                include(constituent.per_unit);
            albedo[b] = std::max(albedo[b], 0.1);
        }
        if (scene.emitters->empty())
            for (std::size_t b = 0; b < optics.bands(); ++b) light[b] = 1;
    }
};

/// One path, from its first vertex to its end.
class PathWalk {
  public:
    PathWalk(const PathTables& tables, const CameraSegment::Light& light, PathRandom& random,
             PathTerms& terms)
        : tables_(tables), light_(light), random_(random), terms_(terms) {}

    PathState& state() { return state_; }

    /// Begins with a scattering at `point` of `segment`, or with a reflection at its end.
    void from_water(const WaterSegment& segment, const WaterPoint& point);
    void from_surface(const WaterSegment& segment);
    /// What the surface at the end of `segment` reflects of light that was scattered or reflected
    /// once before, and no more.
    void mirror(const WaterSegment& segment);

  private:
    struct Continuation;
    struct Workspace;

    static Workspace& workspace_of_thread();

    // Gathers the light that arrives at the workspace's vertex, and finds the path's next segment;
    // false if it ends there, as it does anyhow if this `is_last`.
    bool leave(const Point3& origin, bool is_last = false);
    void gather_along(const DrawnLobe& lobe, const Continuation& along, const Point3& origin);
    void continuation(const Vector3& direction, Continuation& along) const;
    double survival(const Continuation& along, double least) const;
    double branches(double value, double by_own, double by_lobe) const;
    PathState continued(const Continuation& along, double survival) const;
    void trace(const Ray& ray);
    void follow(bool goes_on);
    // Each moves to the next vertex and on from there; false if the path ends.
    bool advance();
    bool reflect_at_end(double probability);
    bool scatter_on_the_way(double u);

    const PathTables& tables_;
    const CameraSegment::Light& light_;
    PathRandom& random_;
    PathTerms& terms_;
    PathState state_;
};

struct PathTables;
struct ScatteringTables;

/// Where light paths take optical depths between lamps and points from.
struct PathOptions {
    /// One per emitter: their columns and no others. Empty: columns are exact.
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows{};
};

/// Unbiased estimates of all light by random paths from the camera (docs/multiple.md). Thread safe.
class PathTracer {
  public:
    explicit PathTracer(const LitScene& scene, const PathOptions& options = {});
    ~PathTracer();
    PathTracer(const PathTracer&) = delete;
    PathTracer& operator=(const PathTracer&) = delete;
    PathTracer(PathTracer&&) = delete;
    PathTracer& operator=(PathTracer&&) = delete;

    /// Prepares a camera ray: `hit` is the first surface along it, null for none; `surface_light`
    /// an estimate of that surface's radiance, per band, that guides the paths; may be empty.
    void begin(const Ray& ray, const SurfaceHit* hit, std::span<const double> surface_light,
               CameraSegment& segment) const;

    /// The light of lamps that the water scatters once, towards the camera.
    void trace_single(const CameraSegment& segment, PathRandom& random, PathTerms& terms) const;
    /// The rest of the light that the water scatters towards the camera: `multiple.volume`.
    void trace_water(const CameraSegment& segment, PathRandom& random, PathTerms& terms) const;
    /// The light that the segment's surface reflects, other than direct light of lamps, and not
    /// what it emits: `multiple.surface`. Nothing without a surface.
    void trace_surface(const CameraSegment& segment, PathRandom& random, PathTerms& terms) const;
    /// Traces the part of trace_surface's light that was scattered or reflected once, or emitted,
    /// before the sample reflects it. It is the light at the surface itself, not dimmed by the
    /// water in front of it.
    void trace_mirrored(const SurfaceSample& sample, PathRandom& random, PathTerms& terms) const;
    /// Whether a term of trace_surface is one of trace_mirrored.
    static bool is_mirrored(const PathTerm& term) {
        return term.scatterings + term.reflections == (term.lamp == k_no_lamp ? 1 : 2);
    }

  private:
    const PathTables& choose_tables(PathRandom& random) const;
    void place_intervals(CameraSegment& segment) const;
    void weigh_intervals(std::span<const double> surface_light, CameraSegment& segment) const;

    std::unique_ptr<const ScatteringTables> scattering_;
    std::vector<LampView> views_;
    std::vector<std::unique_ptr<const PathTables>> tables_;  // one per view
};

}  // namespace uw
