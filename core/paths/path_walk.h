#pragma once

#include <optional>
#include <vector>

#include "core/base/random.h"
#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/paths/direction_sampler.h"
#include "core/paths/path_segment.h"
#include "core/paths/path_tables.h"

namespace uw {

class IrradianceCache;

/// The share of the ambient light that a path is expected to find beyond what is known of it.
inline constexpr double k_ambient_beyond = 0.02;

/// One path, from its first sampler to its end.
class PathWalk {
  public:
    PathWalk(const PathTables& tables, const CameraSegment::Expected& expected, PathRandom& random,
             ContributionSink& sink)
        : tables_(tables), expected_(expected), random_(random), sink_(sink) {}

    PathState& state() { return state_; }
    /// What it has taken: vertices at which a direction was chosen by all that is known, and a
    /// small part of each other.
    double work() const { return work_; }
    /// Ends the path at surfaces and leaves out what they emit and reflect.
    void stay_in_water() { stays_in_water_ = true; }

    /// Begins with a scattering at `point` of `segment`, or with a reflection at its end.
    void from_water(const WaterSegment& segment, const WaterPoint& point);
    void from_surface(const WaterSegment& segment);
    /// Begins with reflections at its end, as many as their light is worth relative to the pixel's.
    void split_at_surface(const WaterSegment& segment);
    /// What the surface at the end of `segment` reflects of light that was scattered or reflected
    /// once before, and no more.
    void mirror(const WaterSegment& segment);
    /// Is scattered on `segment`, and on by the phase function alone until it meets a surface,
    /// which is the end of this; null if it meets none.
    const WaterSegment* wander(const WaterSegment& segment);
    /// The light of the surface at which it has ended: by looking up what is not direct, or by
    /// going on from there.
    void trace_lit_surface(const IrradianceCache& indirect);
    void trace_lit_surface();

  private:
    struct Workspace;

    static Workspace& workspace_of_thread();

    // Tells of a turn, which is the path's last from now on.
    void add_vertex(PathVertex::Kind kind, const Point3& position, const SurfaceHit* hit = nullptr);
    // Gathers the light that arrives at the workspace's sampler from a direction that it draws,
    // along which the path may go on; false if it ends there, as it does anyhow if this `is_last`.
    bool leave(const Point3& origin, bool is_last = false);
    ExpectedRadiance expected_from(const Point3& x) const;
    double splitting_factor(const DirectionCandidate& chosen) const;
    // Whether the segment ends at the water's surface, which reflects the path along
    // mirrored_ray() with this reflectance.
    bool meets_water_surface() const;
    Ray mirrored_ray() const;
    double reflectance_of_water_surface() const;
    double radiance_in_mirror(const Spectrum& throughput);
    // Moves on to the segment that begins there, and gathers its light. The throughput is that at
    // the surface, after reflection.
    void follow_mirrored();
    void estimate_next_event();
    void find_surface_ahead();
    void find_emission(const Spectrum& throughput);
    double arriving(double radiance) const;
    void estimate_surface_light();
    void trace(const Ray& ray);
    void find_transmittance();  // of the segment
    void follow(bool goes_on);
    // Moves to the next sampler and on from there; false if the path ends.
    bool advance();
    double draw_places(const Spectrum& to_end);
    // The distance of the next scattering on the segment, by w.shares of what the bands lose on the
    // way to its end; its length if there is none.
    double draw_distance(double u) const;
    // Moves there; the shares are relative to all that may happen on the segment. False if the
    // water does nothing there.
    bool go_to(double distance);
    // Whether there is a surface before; if so, it ends the segment.
    bool meets_surface_before(double distance);

    const PathTables& tables_;
    CameraSegment::Expected expected_;
    PathRandom& random_;
    ContributionSink& sink_;
    PathState state_;
    double work_ = 0;
    bool stays_in_water_ = false;
};

/// Per thread: paths do not allocate.
struct PathWalk::Workspace {
    /// A branch of a path that has yet to be followed.
    struct Pending {
        PathState state;
        Ray ray;
    };
    /// Where a path may be scattered next on its segment.
    struct Place {
        double distance = 0;
        double light = 0;  // guessed to be scattered along the path there, per unit of throughput
        double scatters = 0;  // b, summed over the bands with the throughput up to there [1/m]
        double density = 0;   // with which any of the places is drawn there, times their number
        double weight() const { return scatters * light / density; }
    };

    WaterSegment segment, first_segment;
    WaterPoint point;
    Spectrum transmittance;
    std::vector<double> c, shares, cumulative;
    DirectionSampler sampler;
    std::vector<double> indirect;  // by lamp and band
    std::vector<Pending> pending;
    std::vector<DirectionCandidate> candidates;
    std::vector<Place> places;
    const GuidingDistribution* guides = nullptr;  // at the beginning of the segment
    GuidingDistribution guides_of_pending, guides_of_mirrored, guides_at_water_surface;
    // What the surface at its end reflects, roughly, and what of that arrives at the camera, summed
    // over the bands.
    double surface_radiance = 0, surface_ahead = 0;
};

}  // namespace uw
