#pragma once

#include <optional>
#include <vector>

#include "core/base/random.h"
#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/paths/path_segment.h"
#include "core/paths/path_tables.h"
#include "core/paths/path_vertex.h"

namespace uw {

class IndirectLight;

/// The light that a path may meet anywhere, relative to that of the surface its pixel sees.
inline constexpr double k_ambient_share = 0.5;

/// One path, from its first vertex to its end.
class PathWalk {
  public:
    PathWalk(const PathTables& tables, const CameraSegment::Light& light, PathRandom& random,
             PathTerms& terms)
        : tables_(tables), light_(light), random_(random), terms_(terms) {}

    PathState& state() { return state_; }
    /// Ends the path at surfaces and leaves out what they emit and reflect.
    void stay_in_water() { stays_in_water_ = true; }

    /// Begins with a scattering at `point` of `segment`, or with a reflection at its end.
    void from_water(const WaterSegment& segment, const WaterPoint& point);
    void from_surface(const WaterSegment& segment);
    /// What the surface at the end of `segment` reflects of light that was scattered or reflected
    /// once before, and no more.
    void mirror(const WaterSegment& segment);
    /// Is scattered on `segment`, and on by the phase function alone until it meets a surface,
    /// which is the end of this; null if it meets none.
    const WaterSegment* wander(const WaterSegment& segment);
    /// The light of the surface at which it has ended.
    void gather_lit_surface(const IndirectLight& indirect);

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
    void find_emission(const Spectrum& throughput);
    PathState continued(const Continuation& along, double survival) const;
    void trace(const Ray& ray);
    void find_transmittance();  // of the segment
    void follow(bool goes_on);
    // Each moves to the next vertex and on from there; false if the path ends.
    bool advance();
    bool reflect_at_end(double probability);
    bool scatter_on_the_way(double u);
    // The distance of the next scattering on the segment, by w.shares of what the bands lose on the
    // way to its end; its length if there is none.
    double draw_distance(double u) const;
    // Moves there; the shares are relative to all that may happen on the segment. False if the
    // water does nothing there.
    bool go_to(double distance);
    // Whether there is a surface before; if so, it ends the segment.
    bool meets_surface_before(double distance);

    const PathTables& tables_;
    CameraSegment::Light light_;
    PathRandom& random_;
    PathTerms& terms_;
    PathState state_;
    bool stays_in_water_ = false;
};

/// A direction in which a path may go on from a vertex.
struct PathWalk::Continuation {
    Spectrum response;                   // PathVertex::respond
    double own_density = 0;              // of PathVertex::draw
    std::vector<double> lobe_densities;  // by lamp, of PathVertex::draw_lobe
    double density = 0;                  // the sum of them
    double value = 0;  // what may still arrive at the camera from there [W m^-2 sr^-1]
};

/// Per thread: paths do not allocate.
struct PathWalk::Workspace {
    /// A branch of a path that has yet to be followed.
    struct Pending {
        PathState state;
        Ray ray;
    };

    WaterSegment segment, lobe_segment;
    WaterPoint point;
    Spectrum transmittance;
    std::vector<double> c, shares, cumulative;
    PathVertex vertex;
    Continuation along_own, along_lobe;
    std::vector<double> chosen_lamp;  // a weight for each
    std::vector<double> indirect;     // by lamp and band
    std::vector<Pending> pending;
};

}  // namespace uw
