#include "media/light/shadow_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/light/ray_panels.h"
#include "media/light/light_projection.h"

namespace uw {

namespace {

constexpr float k_nothing = std::numeric_limits<float>::infinity();

}  // namespace

DepthPyramid::DepthPyramid(const Grid2D<float>& samples) {
    levels_.push_back(cell_ranges(samples));
    while (levels_.back().width() > 1) levels_.push_back(halved(levels_.back()));
}

// Four samples bound the depths of a plane between them: 1 / depth is linear over it as viewed from
// a point, and depth is along parallel rays.
DepthPyramid::Level DepthPyramid::cell_ranges(const Grid2D<float>& samples) {
    const int n = samples.width() - 1;
    Level level(n, n);
    for (int v = 0; v < n; ++v) {
        const float* const above = samples.row(v).data();
        const float* const below = samples.row(v + 1).data();
        DepthRange* const cells = level.row(v).data();
        for (int u = 0; u < n; ++u) {
            const float nearest = std::min({above[u], above[u + 1], below[u], below[u + 1]});
            // Cells outside the beam have no bounds.
            cells[u] = nearest == k_untraced
                           ? DepthRange{k_nothing, 0}
                           : DepthRange{nearest,
                                        std::max({above[u], above[u + 1], below[u], below[u + 1]})};
        }
    }
    return level;
}

DepthPyramid::Level DepthPyramid::halved(const Level& fine) {
    const int size = (fine.width() + 1) / 2, last = fine.width() - 1;
    Level coarse(size, size);
    for (int v = 0; v < size; ++v) {
        const DepthRange* const above = fine.row(2 * v).data();
        const DepthRange* const below = fine.row(std::min(2 * v + 1, last)).data();
        DepthRange* const cells = coarse.row(v).data();
        for (int u = 0; u < size; ++u) {
            const int left = 2 * u, right = std::min(2 * u + 1, last);
            cells[u] = {std::min({above[left].nearest, above[right].nearest, below[left].nearest,
                                  below[right].nearest}),
                        std::max({above[left].farthest, above[right].farthest, below[left].farthest,
                                  below[right].farthest})};
        }
    }
    return coarse;
}

DepthRange DepthPyramid::bound(int u0, int v0, int u1, int v1) const {
    std::size_t level = 0;
    while (u1 - u0 > 1 || v1 - v0 > 1) {
        u0 /= 2, u1 /= 2, v0 /= 2, v1 /= 2;
        ++level;
    }
    const Level& cells = levels_[level];
    DepthRange range{k_nothing, 0};
    for (int v = v0; v <= v1; ++v) {
        for (int u = u0; u <= u1; ++u) {
            const DepthRange& cell = cells(u, v);
            range.nearest = std::min(range.nearest, cell.nearest);
            range.farthest = std::max(range.farthest, cell.farthest);
        }
    }
    return range;
}

std::size_t DepthPyramid::bytes() const {
    std::size_t total = 0;
    for (const Level& level : levels_) total += level.size() * sizeof(DepthRange);
    return total;
}

/// Collects the lit parts of an interval of a ray, in ascending order, and finds the edges of
/// shadows that a shadow map cannot decide by exact shadow rays. `Origin` returns the origin of the
/// light that reaches a point. (Not in the anonymous namespace, as members of classes that the
/// header declares have this type.)
template <class Origin>
class LitEdges {
  public:
    /// What is referred to must outlive this object.
    LitEdges(const Surfaces& surfaces, Origin origin, const Ray& ray, std::vector<Interval>& lit)
        : surfaces_(surfaces), origin_(origin), ray_(ray), lit_(lit) {}

    /// Sets the interval that contains all those that follow.
    void set_interval(const Interval& interval) { interval_ = interval; }

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

    // Tells whether the end of an interval is lit. The ends of the whole interval may lie on a
    // surface, which occludes nothing within 1e-5 of the distance (Surfaces::occluded), so that
    // visibility is decided slightly inside the interval there.
    bool visible_at_end(double s, double into) {
        if (s == last_visibility_.s) return last_visibility_.visible;
        const bool is_end = s == interval_.begin || s == interval_.end;
        const Point3 x = ray_.at(s);
        const double inset = std::min(0.25 * std::abs(into - s), 3e-5 * distance(origin_(x), x));
        last_visibility_ = {s, visible(is_end ? s + std::copysign(inset, into - s) : s)};
        return last_visibility_.visible;
    }

    // Neighbouring intervals share an end.
    struct EndVisibility {
        double s = -1;
        bool visible = false;
    };

    const Surfaces& surfaces_;
    Origin origin_;
    const Ray& ray_;
    Interval interval_;
    std::vector<Interval>& lit_;
    EndVisibility last_visibility_;
};

namespace {

/// A point of a ray in the coordinates of a shadow map.
struct MapPoint {
    double s;      // along the ray [m]
    double depth;  // as the map's depths [m]
    double u, v;   // in texels
};

/// How far apart two points are on the map [texels].
double texels_between(const MapPoint& a, const MapPoint& b) {
    return std::max(std::abs(a.u - b.u), std::abs(a.v - b.v));
}

/// The nearest and farthest surface over the cells that the interval from `a` to `b` touches. The
/// first of the cells, of which there are `cells` along an edge, begins at -`offset` texels.
DepthRange bound(const DepthPyramid& pyramid, const MapPoint& a, const MapPoint& b, double offset,
                 int cells) {
    const auto cell = [&](double t) {
        return std::clamp(static_cast<int>(std::floor(t + offset)), 0, cells - 1);
    };
    return pyramid.bound(cell(std::min(a.u, b.u)), cell(std::min(a.v, b.v)),
                         cell(std::max(a.u, b.u)), cell(std::max(a.v, b.v)));
}

// The margin within which a cell lies entirely, from any direction in it: its diagonal, doubled.
constexpr double k_beam_margin_texels = 3;
// The map's depths are float and its texels are compared with points between their centres; a
// decision requires this relative margin, otherwise the search falls back to exact shadow rays.
constexpr double k_margin = 1e-3;
// A shadow's edge is located to this fraction of its distance from the lamp, with an average error
// of half of it: the in-scatter over that length is less than 1e-4 of that of the ray as it passes
// the lamp.
constexpr double k_edge_width = 3e-4;

}  // namespace

ShadowMap::ShadowMap(const Surfaces& surfaces, const Point3& lamp, int resolution,
                     const DirectionCone& beam)
    : surfaces_(&surfaces), lamp_(lamp), resolution_(resolution), beam_(beam) {
    if (surfaces.empty()) return;
    for (int face = 0; face < 6; ++face) trace_face(face);
}

void ShadowMap::trace_face(int face_index) {
    const CubeFace face(face_index);
    const int n = resolution_;
    const int padded = n + 2;  // one texel beyond each edge, so that neighbours always exist
    // This contains all samples of the cells that the beam touches.
    const DirectionCone wide = beam_.widened(k_beam_margin_texels * 2.0 / n);
    Grid2D<float> depth(padded, padded, DepthPyramid::k_untraced);
    std::atomic<std::uint64_t> traced = 0;
    parallel_for(static_cast<std::size_t>(padded), [&](std::size_t row) {
        std::vector<Vector3> directions;
        std::vector<double> hits;
        std::vector<std::size_t> columns;
        const double v = (2.0 * static_cast<double>(row) - 1.0) / n - 1.0;
        const std::span<float> samples = depth.row(static_cast<int>(row));
        const Vector3 middle = face.direction(0, v), across = face.direction(1, v) - middle;
        for (int column = 0; column < padded; ++column) {
            const Vector3 direction = middle + ((2.0 * column - 1.0) / n - 1.0) * across;
            if (!wide.has(direction)) continue;
            directions.push_back(glm::normalize(direction));
            columns.push_back(static_cast<std::size_t>(column));
        }
        hits.resize(directions.size());
        surfaces_->hit_distances(lamp_, directions, hits);
        // Depth is along the face's axis.
        for (std::size_t i = 0; i < hits.size(); ++i)
            samples[columns[i]] = static_cast<float>(hits[i] * face.depth(directions[i]));
        traced += hits.size();
    });
    if (traced == 0) return;
    rays_traced_ += traced;

    faces_[static_cast<std::size_t>(face_index)] = DepthPyramid(depth);
}

std::size_t ShadowMap::bytes() const {
    std::size_t total = 0;
    for (const DepthPyramid& pyramid : faces_) total += pyramid.bytes();
    return total;
}

/// The search along one ray: bisects intervals until the pyramid decides or a texel is reached.
class ShadowMap::Search {
  public:
    Search(const ShadowMap& map, const Ray& ray, std::vector<Interval>& lit)
        : map_(map), ray_(ray), edges_(*map.surfaces_, {map.lamp_}, ray, lit) {}

    void run(const Interval& interval) {
        edges_.set_interval(interval);
        std::vector<FaceSegment> segments;
        split_by_face(ray_, map_.lamp_, interval, segments);
        for (const FaceSegment& segment : segments) {
            face_ = CubeFace(segment.face);
            pyramid_ = &map_.faces_[static_cast<std::size_t>(segment.face)];
            if (pyramid_->empty()) continue;  // outside the beam, if only by rounding
            descend(project(segment.interval.begin), project(segment.interval.end));
        }
    }

    void append(const Interval& interval) { edges_.append(interval); }

  private:
    struct FromLamp {
        Point3 lamp;
        const Point3& operator()(const Point3& /*x*/) const { return lamp; }
    };

    MapPoint project(double s) const {
        const Vector3 x = ray_.at(s) - map_.lamp_;
        const double half = 0.5 * map_.resolution_;
        const double depth = face_.depth(x), texels_per_metre = half / depth;
        return {s, depth, half + x[face_.u_axis] * texels_per_metre,
                half + x[face_.v_axis] * texels_per_metre};
    }

    void descend(const MapPoint& a, const MapPoint& b) {
        // The map has one texel beyond each edge, and its cells lie between the texels' centres.
        const DepthRange range = bound(*pyramid_, a, b, 0.5, map_.resolution_ + 1);
        if (std::max(a.depth, b.depth) * (1 + k_margin) < range.nearest)
            edges_.append({a.s, b.s});
        else if (std::min(a.depth, b.depth) > range.farthest * (1 + k_margin))
            return;
        else if (texels_between(a, b) <= 1 &&
                 std::max(a.depth, b.depth) < 2 * std::min(a.depth, b.depth))
            resolve(a.s, b.s);
        else {
            // Bisects on the face if the interval is long there, else in depth.
            const bool far_on_face = texels_between(a, b) > 1;
            const MapPoint middle =
                project(far_on_face ? (a.s * b.depth + b.s * a.depth) / (a.depth + b.depth)
                                    : 0.5 * (a.s + b.s));
            descend(a, middle);
            descend(middle, b);
        }
    }

    // Appends the lit part of an interval of at most a texel that the map cannot decide.
    void resolve(double begin, double end) {
        edges_.resolve(begin, end,
                       k_edge_width * distance(map_.lamp_, ray_.at(0.5 * (begin + end))));
    }

    const ShadowMap& map_;
    const Ray& ray_;
    LitEdges<FromLamp> edges_;
    CubeFace face_{0};
    const DepthPyramid* pyramid_ = nullptr;
};

void ShadowMap::lit_intervals(const Ray& ray, const Interval& interval,
                              std::vector<Interval>& lit) const {
    lit.clear();
    if (!(interval.length() > 0)) return;
    if (surfaces_->empty()) {
        lit.push_back(interval);
        return;
    }
    Search search(*this, ray, lit);
    // At the lamp's position no direction is defined; points this close count as lit.
    const double foot = glm::dot(lamp_ - ray.origin, ray.direction);
    const double offset = distance(lamp_, ray.at(foot));
    const double half =
        offset < k_lamp_radius ? std::sqrt(k_lamp_radius * k_lamp_radius - offset * offset) : 0.0;
    const Interval core{std::clamp(foot - half, interval.begin, interval.end),
                        std::clamp(foot + half, interval.begin, interval.end)};
    if (half == 0 || core.length() == 0) {
        search.run(interval);
        return;
    }
    search.run({interval.begin, core.begin});
    search.append(core);
    search.run({core.end, interval.end});
}

namespace {

constexpr double k_unbounded = std::numeric_limits<double>::infinity();
// A surface between the corners of a cell may lie this many texels before or behind them before
// exact shadow rays decide.
constexpr double k_sun_margin_texels = 0.25;
constexpr double k_float_rounding = 1e-6;  // of a depth
// A shadow's edge is located to this fraction of a ray's interval, with an average error of half of
// it. An interval is at most 15 attenuation lengths (VolumeIntegrator): 2e-4 of the light on it.
constexpr double k_sun_edge_width = 3e-5;
// Outside the squares an interval is searched for shadows in this many pieces. The shadow of a
// single plane has one edge on a ray, which is found with any number.
constexpr int k_open_pieces = 16;

constexpr int k_max_squares = 4;
constexpr double k_narrower = 4;
// Lower bound on half the width of the smallest square [m].
constexpr double k_min_half = 4;
// A square follows the camera in steps of this fraction of its half width.
constexpr double k_square_step = 0.25;

}  // namespace

SunShadowMap::SunShadowMap(const Surfaces& surfaces, const Sunlight& sun,
                           std::span<const LightSquare> squares, int resolution)
    : surfaces_(&surfaces), frame_(sun), resolution_(resolution) {
    if (surfaces.empty()) return;
    for (const LightSquare& square : squares) trace(square);
}

std::vector<LightSquare> SunShadowMap::squares_around(const Point3& centre, double max_distance,
                                                      const Bounds& surfaces, const Sunlight& sun) {
    if (surfaces.empty()) return {};
    const LightFrame frame(sun);
    const LightPoint middle = frame.point(centre);
    double u_min = k_unbounded, u_max = -k_unbounded, v_min = k_unbounded, v_max = -k_unbounded;
    for (const Point3& corner : corners(surfaces)) {
        const LightPoint p = frame.point(corner);
        u_min = std::min(u_min, p.u), u_max = std::max(u_max, p.u);
        v_min = std::min(v_min, p.v), v_max = std::max(v_max, p.v);
    }
    LightSquare all{0.5 * (u_min + u_max), 0.5 * (v_min + v_max),
                    0.5 * std::max(u_max - u_min, v_max - v_min)};
    const auto around_centre = [&](double half) {
        const double step = k_square_step * half;
        return LightSquare{step * std::round(middle.u / step), step * std::round(middle.v / step),
                           half};
    };
    if (all.half > max_distance) all = around_centre((1 + k_square_step) * max_distance);
    all.half *= 1 + 1e-3;  // a margin for rounding
    std::vector<LightSquare> squares{all};
    for (double half = all.half / k_narrower; half >= k_min_half && squares.size() < k_max_squares;
         half /= k_narrower)
        squares.push_back(around_centre(half));
    std::reverse(squares.begin(), squares.end());
    return squares;
}

void SunShadowMap::trace(const LightSquare& square) {
    const int n = resolution_;
    Level level{square, 0, {}};
    double first = k_unbounded;
    for (const double u : {-square.half, square.half})
        for (const double v : {-square.half, square.half})
            first = std::min(first, frame_.entry_depth(square.u + u, square.v + v));
    level.first_depth = first;
    Grid2D<float> samples(n + 1, n + 1);
    parallel_for(static_cast<std::size_t>(n + 1), [&](std::size_t row) {
        const double v = square.v + square.half * (2.0 * static_cast<double>(row) / n - 1);
        const std::span<float> depths = samples.row(static_cast<int>(row));
        for (int column = 0; column <= n; ++column) {
            throw_if_stopped();
            const double u = square.u + square.half * (2.0 * column / n - 1);
            const double entry = frame_.entry_depth(u, v);
            const Ray ray{frame_.world({u, v, entry}), frame_.sun().direction};
            depths[static_cast<std::size_t>(column)] =
                static_cast<float>(entry + surfaces_->hit_distance(ray) - first);
        }
    });
    rays_traced_ += samples.size();
    level.depths = DepthPyramid(samples);
    levels_.push_back(std::move(level));
}

std::size_t SunShadowMap::bytes() const {
    std::size_t total = 0;
    for (const Level& level : levels_) total += level.depths.bytes();
    return total;
}

/// The search along one ray: bisects intervals until a pyramid decides or a texel is reached.
class SunShadowMap::Search {
  public:
    Search(const SunShadowMap& map, const Ray& ray, const Interval& whole,
           std::vector<Interval>& lit)
        : map_(map),
          whole_(whole),
          begin_(map.frame_.point(ray.origin)),
          rates_(map.frame_.rates(ray.direction)),
          edges_(*map.surfaces_, {map.frame_.sun()}, ray, lit),
          edge_width_(k_sun_edge_width * whole.length()) {
        edges_.set_interval(whole);
    }

    /// Appends the lit parts of `interval`, by the squares from this one on.
    void run(std::size_t square, const Interval& interval) {
        if (!(interval.length() > 0)) return;
        if (square == map_.levels_.size()) {
            look_for_edges(interval);
            return;
        }
        const Level& level = map_.levels_[square];
        const Interval part = inside(begin_, rates_, interval, {level.square.u, level.square.v, 0},
                                     level.square.half, level.square.half);
        if (!(part.length() > 0)) {
            run(square + 1, interval);
            return;
        }
        run(square + 1, {interval.begin, part.begin});
        level_ = &level;
        descend(project(part.begin), project(part.end));
        run(square + 1, {part.end, interval.end});
    }

  private:
    struct FromSurface {
        const Sunlight& sun;
        Point3 operator()(const Point3& x) const { return sun.entry(x); }
    };

    MapPoint project(double s) const {
        const LightSquare& square = level_->square;
        const double texels = 0.5 * map_.resolution_ / square.half;  // per metre
        return {s, begin_.depth + s * rates_.depth - level_->first_depth,
                (begin_.u + s * rates_.u - square.u + square.half) * texels,
                (begin_.v + s * rates_.v - square.v + square.half) * texels};
    }

    void descend(const MapPoint& a, const MapPoint& b) {
        const DepthRange range = bound(level_->depths, a, b, 0, map_.resolution_);
        const double least = std::min(a.depth, b.depth), most = std::max(a.depth, b.depth);
        const double margin = k_sun_margin_texels * 2 * level_->square.half / map_.resolution_ +
                              k_float_rounding * most;
        if (most + margin < range.nearest) {
            edges_.append({a.s, b.s});
        } else if (least - margin > range.farthest) {
            return;
        } else if (texels_between(a, b) <= 1) {
            edges_.resolve(a.s, b.s, edge_width_);
        } else {
            const MapPoint middle = project(0.5 * (a.s + b.s));
            descend(a, middle);
            descend(middle, b);
        }
    }

    void look_for_edges(const Interval& interval) {
        const double least = whole_.length() / k_open_pieces;
        const auto pieces = static_cast<int>(std::ceil(interval.length() / least));
        const double length = interval.length() / pieces;
        for (int i = 0; i < pieces; ++i)
            edges_.resolve(interval.begin + i * length,
                           i + 1 < pieces ? interval.begin + (i + 1) * length : interval.end,
                           edge_width_);
    }

    const SunShadowMap& map_;
    Interval whole_;
    LightPoint begin_, rates_;
    LitEdges<FromSurface> edges_;
    double edge_width_;  // [m]
    const Level* level_ = nullptr;
};

void SunShadowMap::lit_intervals(const Ray& ray, const Interval& interval,
                                 std::vector<Interval>& lit) const {
    lit.clear();
    if (!(interval.length() > 0)) return;
    if (surfaces_->empty()) {
        lit.push_back(interval);
        return;
    }
    Search(*this, ray, interval, lit).run(0, interval);
}

}  // namespace uw
