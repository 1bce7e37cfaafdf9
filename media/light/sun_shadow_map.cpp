#include "media/light/sun_shadow_map.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/stop.h"
#include "media/light/bounds_corners.h"
#include "media/light/lit_edges.h"

namespace uw {

namespace {

// A surface between the corners of a cell may lie this many texels before or behind them before
// exact shadow rays decide.
constexpr double k_sun_margin_texels = 0.25;
constexpr double k_float_rounding = 1e-6;  // of a depth
// A shadow's edge is located to this fraction of a ray's stretch, with an average error of half of
// it. A stretch is at most 15 attenuation lengths (VolumeIntegrator): 2e-4 of the light on it.
constexpr double k_sun_edge_width = 3e-5;
// Outside the squares: how finely shadows are looked for. The shadow of a single plane has one edge
// on a ray, which is found whatever this number.
constexpr int k_open_pieces = 16;

constexpr int k_most_squares = 4;
constexpr double k_narrower = 4;
// Half the width of the smallest square, at most twice that [m].
constexpr double k_least_half = 4;
// A square follows the camera in steps of this fraction of its half width.
constexpr double k_square_step = 0.25;

}  // namespace

SunShadowMap::SunShadowMap(const Surfaces& surfaces, const Sunlight& sun,
                           std::span<const LightSquare> squares, int resolution)
    : surfaces_(&surfaces), frame_(sun), resolution_(resolution) {
    if (surfaces.empty()) return;
    for (const LightSquare& square : squares) trace(square);
}

std::vector<LightSquare> SunShadowMap::squares_around(const Point3& centre, double reach,
                                                      const Bounds& surfaces, const Sunlight& sun) {
    if (surfaces.empty()) return {};
    const LightFrame frame(sun);
    const LightPoint middle = frame.point(centre);
    double u_min = k_infinity, u_max = -k_infinity, v_min = k_infinity, v_max = -k_infinity;
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
    if (all.half > reach) all = around_centre((1 + k_square_step) * reach);
    all.half *= 1 + 1e-3;  // with what a rounding leaves outside
    std::vector<LightSquare> squares{all};
    for (double half = all.half / k_narrower;
         half >= k_least_half && squares.size() < k_most_squares; half /= k_narrower)
        squares.push_back(around_centre(half));
    std::reverse(squares.begin(), squares.end());
    return squares;
}

void SunShadowMap::trace(const LightSquare& square) {
    const int n = resolution_;
    Level level{square, 0, {}};
    double first = k_infinity;
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
        edges_.set_stretch(whole);
    }

    // By the squares from this one on.
    void run(std::size_t square, const Interval& stretch) {
        if (!(stretch.length() > 0)) return;
        if (square == map_.levels_.size()) {
            look_for_edges(stretch);
            return;
        }
        const Level& level = map_.levels_[square];
        const Interval part = inside(begin_, rates_, stretch, {level.square.u, level.square.v, 0},
                                     level.square.half, level.square.half);
        if (!(part.length() > 0)) {
            run(square + 1, stretch);
            return;
        }
        run(square + 1, {stretch.begin, part.begin});
        level_ = &level;
        descend(project(part.begin), project(part.end));
        run(square + 1, {part.end, stretch.end});
    }

  private:
    struct FromSurface {
        const Sunlight& sun;
        Point3 operator()(const Point3& x) const { return sun.entry(x); }
    };
    struct MapPoint {
        double s;      // along the ray
        double depth;  // from the level's first
        double u, v;   // in texels
    };

    MapPoint project(double s) const {
        const LightSquare& square = level_->square;
        const double texels = 0.5 * map_.resolution_ / square.half;  // per metre
        return {s, begin_.depth + s * rates_.depth - level_->first_depth,
                (begin_.u + s * rates_.u - square.u + square.half) * texels,
                (begin_.v + s * rates_.v - square.v + square.half) * texels};
    }

    void descend(const MapPoint& a, const MapPoint& b) {
        const auto cell = [&](double t) {
            return std::clamp(static_cast<int>(std::floor(t)), 0, map_.resolution_ - 1);
        };
        const DepthRange range =
            level_->depths.bound(cell(std::min(a.u, b.u)), cell(std::min(a.v, b.v)),
                                 cell(std::max(a.u, b.u)), cell(std::max(a.v, b.v)));
        const double least = std::min(a.depth, b.depth), most = std::max(a.depth, b.depth);
        const double margin = k_sun_margin_texels * 2 * level_->square.half / map_.resolution_ +
                              k_float_rounding * most;
        if (most + margin < range.nearest) {
            edges_.append({a.s, b.s});
        } else if (least - margin > range.farthest) {
            return;
        } else if (std::max(std::abs(a.u - b.u), std::abs(a.v - b.v)) <= 1) {
            edges_.resolve(a.s, b.s, edge_width_);
        } else {
            const MapPoint middle = project(0.5 * (a.s + b.s));
            descend(a, middle);
            descend(middle, b);
        }
    }

    void look_for_edges(const Interval& stretch) {
        const double least = whole_.length() / k_open_pieces;
        const auto pieces = static_cast<int>(std::ceil(stretch.length() / least));
        const double length = stretch.length() / pieces;
        for (int i = 0; i < pieces; ++i)
            edges_.resolve(stretch.begin + i * length,
                           i + 1 < pieces ? stretch.begin + (i + 1) * length : stretch.end,
                           edge_width_);
    }

    const SunShadowMap& map_;
    Interval whole_;
    LightPoint begin_, rates_;
    LitEdges<FromSurface> edges_;
    double edge_width_;  // [m]
    const Level* level_ = nullptr;
};

void SunShadowMap::lit_intervals(const Ray& ray, const Interval& stretch,
                                 std::vector<Interval>& lit) const {
    lit.clear();
    if (!(stretch.length() > 0)) return;
    if (surfaces_->empty()) {
        lit.push_back(stretch);
        return;
    }
    Search(*this, ray, stretch, lit).run(0, stretch);
}

}  // namespace uw
