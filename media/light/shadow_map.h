#pragma once

#include <array>
#include <vector>

#include "core/lamps/direction_cone.h"
#include "core/surfaces/surfaces.h"
#include "media/light/cube_face.h"
#include "media/light/depth_pyramid.h"

namespace uw {

/// Visibility from one lamp: the depth of the nearest surface over all directions, as pyramids of
/// least and greatest depth on the faces of a cube. It classifies whole intervals of a ray as lit
/// or shadowed at once; where the map is inconclusive, exact shadow rays locate the edge.
class ShadowMap {
  public:
    /// Traces those of the `resolution`^2 rays on each face that lie within `beam`. `surfaces` must
    /// outlive the map.
    ShadowMap(const Surfaces& surfaces, const Point3& lamp, int resolution,
              const DirectionCone& beam = {});

    /// The directions that the map covers.
    const DirectionCone& beam() const { return beam_; }

    /// The parts of the interval `stretch` of `ray`, within the beam, that the lamp illuminates,
    /// ascending and disjoint. Edges are accurate to 2e-4 of their distance from the lamp. A shadow
    /// narrower than a texel may be missed.
    void lit_intervals(const Ray& ray, const Interval& stretch, std::vector<Interval>& lit) const;

    std::uint64_t rays_traced() const { return rays_traced_; }
    std::size_t bytes() const;

  private:
    class Search;

    void trace_face(int face);

    const Surfaces* surfaces_;
    Point3 lamp_;
    int resolution_;
    DirectionCone beam_;
    std::array<DepthPyramid, 6> faces_;  // empty for faces outside the beam
    std::uint64_t rays_traced_ = 0;
};

}  // namespace uw
