#pragma once

#include "core/paths/camera_segment.h"
#include "core/paths/path_random.h"
#include "core/paths/path_state.h"
#include "core/paths/path_tables.h"
#include "core/paths/path_terms.h"

namespace uw {

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

}  // namespace uw
