#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/geometry/surfaces.h"
#include "core/light/lamp_profile.h"
#include "media/light/light_projection.h"

namespace uw {

/// The depths of surfaces within a part of a shadow map.
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
    /// Over the cells from (u0, v0) to (u1, v1), and perhaps some around them.
    DepthRange bound(int u0, int v0, int u1, int v1) const;
    std::size_t bytes() const;

  private:
    using Level = Grid2D<DepthRange>;

    static Level cell_ranges(const Grid2D<float>& samples);
    static Level halved(const Level& fine);

    std::vector<Level> levels_;
};

/// Collects the lit intervals of a stretch of a ray, in ascending order, and finds edges of shadows
/// that a shadow map cannot decide by exact shadow rays. `Origin` tells where the light that
/// reaches a point comes from.
template <class Origin>
class LitEdges {
  public:
    /// What is referred to must outlive this object.
    LitEdges(const Surfaces& surfaces, Origin origin, const Ray& ray, std::vector<Interval>& lit)
        : surfaces_(surfaces), origin_(origin), ray_(ray), lit_(lit) {}

    /// Of what follows, up to the next call.
    void set_stretch(const Interval& stretch) { stretch_ = stretch; }

    void append(const Interval& interval) {
        if (!lit_.empty() && lit_.back().end == interval.begin)
            lit_.back().end = interval.end;
        else
            lit_.push_back(interval);
    }

    /// Appends the lit part of an interval with at most one edge, which is found to within `width`
    /// [m].
    void resolve(double begin, double end, double width) {
        const bool lit_at_begin = visible_at_end(begin, end);
        const bool lit_at_end = visible_at_end(end, begin);
        if (lit_at_begin == lit_at_end) {
            if (lit_at_begin) append({begin, end});
            return;
        }
        double a = begin, b = end;
        while (b - a > width) {
            const double middle = 0.5 * (a + b);
            (visible(middle) == lit_at_begin ? a : b) = middle;
        }
        const double edge = 0.5 * (a + b);
        append(lit_at_begin ? Interval{begin, edge} : Interval{edge, end});
    }

  private:
    bool visible(double s) const {
        const Point3 x = ray_.at(s);
        return !surfaces_.occluded(origin_(x), x);
    }

    // Visibility at the end of an interval; slightly inside it at the ends of the whole stretch,
    // which may lie on a surface, since a surface occludes nothing within 1e-5 of the distance
    // (Surfaces::occluded).
    bool visible_at_end(double s, double into) {
        if (s == last_seen_.s) return last_seen_.visible;
        const bool is_end = s == stretch_.begin || s == stretch_.end;
        const Point3 x = ray_.at(s);
        const double inset = std::min(0.25 * std::abs(into - s), 3e-5 * distance(origin_(x), x));
        last_seen_ = {s, visible(is_end ? s + std::copysign(inset, into - s) : s)};
        return last_seen_.visible;
    }

    // Neighbouring intervals share an end.
    struct Seen {
        double s = -1;
        bool visible = false;
    };

    const Surfaces& surfaces_;
    Origin origin_;
    const Ray& ray_;
    Interval stretch_;
    std::vector<Interval>& lit_;
    Seen last_seen_;
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

/// Visibility of a sun: what a ShadowMap is for a lamp, with parallel rays over squares across the
/// light, the finest of which decides. Outside them, where only endless surfaces cast shadows,
/// exact shadow rays look for their edges. What lies above the water's surface casts none.
class SunShadowMap {
  public:
    /// Traces `resolution`^2 rays in each of `squares`, which lie within each other, the smallest
    /// first. `surfaces` must outlive the map.
    SunShadowMap(const Surfaces& surfaces, const Sunlight& sun,
                 std::span<const LightSquare> squares, int resolution);

    /// The squares with which everything near `centre` is resolved best: the largest holds all
    /// finite surfaces, but reaches no farther than `reach` from `centre` [m], and each other is a
    /// quarter of the next as wide and lies around `centre`, which may move within it a little
    /// before it follows. None without finite surfaces.
    static std::vector<LightSquare> squares_around(const Point3& centre, double reach,
                                                   const Bounds& surfaces, const Sunlight& sun);

    /// As DeepShadow::lit_intervals. Edges are accurate to 3e-5 of the stretch; a shadow narrower
    /// than a texel may be missed.
    void lit_intervals(const Ray& ray, const Interval& stretch, std::vector<Interval>& lit) const;

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
