#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/geometry/surfaces.h"
#include "core/light/lamp_profile.h"
#include "media/light/light_projection.h"

namespace uw {

/// The depths of surfaces within a part of a shadow map [m].
struct DepthRange {
    float nearest;
    float farthest;
};

/// Least and greatest depth over the cells of a shadow map, and over squares of 2, 4, 8... of them.
class DepthPyramid {
  public:
    /// A depth that was not traced.
    static constexpr float k_untraced = -1;

    DepthPyramid() = default;
    /// `samples`: the depths at the corners of the cells, as many across as down, infinite where
    /// there is nothing; a cell without a traced corner has no bounds (bound).
    explicit DepthPyramid(const Grid2D<float>& samples);

    bool empty() const { return levels_.empty(); }
    /// The depths over the cells from (u0, v0) to (u1, v1), both included, and perhaps some around
    /// them.
    DepthRange bound(int u0, int v0, int u1, int v1) const;
    std::size_t bytes() const;

  private:
    using Level = Grid2D<DepthRange>;

    static Level cell_ranges(const Grid2D<float>& samples);
    static Level halved(const Level& fine);

    std::vector<Level> levels_;
};

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

    /// The parts of the interval `interval` of `ray`, within the beam, that the lamp illuminates,
    /// ascending and disjoint. Edges are accurate to 2e-4 of their distance from the lamp. A shadow
    /// narrower than a texel may be missed.
    void lit_intervals(const Ray& ray, const Interval& interval, std::vector<Interval>& lit) const;

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

/// Visibility of a sun: what a ShadowMap is for a lamp, with parallel rays over squares across the
/// light, the finest of which decides. Outside them, where only endless surfaces cast shadows,
/// exact shadow rays look for their edges. Surfaces above the water cast none.
class SunShadowMap {
  public:
    /// Traces `resolution`^2 rays in each of `squares`, which lie within each other, the smallest
    /// first. `surfaces` must outlive the map.
    SunShadowMap(const Surfaces& surfaces, const Sunlight& sun,
                 std::span<const LightSquare> squares, int resolution);

    /// Nested squares with the finest resolution near `centre`: the largest contains all finite
    /// surfaces, but extends no farther than `max_distance` from `centre` [m]; each of the others
    /// is a quarter as wide as the next one and lies around `centre`, on a lattice, so that it
    /// stays the same while `centre` moves a little. None without finite surfaces.
    static std::vector<LightSquare> squares_around(const Point3& centre, double max_distance,
                                                   const Bounds& surfaces, const Sunlight& sun);

    /// As DeepShadow::lit_intervals. Edges are accurate to 3e-5 of the interval; a shadow narrower
    /// than a texel may be missed.
    void lit_intervals(const Ray& ray, const Interval& interval, std::vector<Interval>& lit) const;

    std::uint64_t rays_traced() const { return rays_traced_; }
    std::size_t bytes() const;

  private:
    struct Level {
        LightSquare square;
        double first_depth = 0;  // from which depths count
        DepthPyramid depths;
    };
    class Search;

    void trace(const LightSquare& square);

    const Surfaces* surfaces_;
    LightFrame frame_;
    int resolution_;
    std::vector<Level> levels_;
    std::uint64_t rays_traced_ = 0;
};

}  // namespace uw
