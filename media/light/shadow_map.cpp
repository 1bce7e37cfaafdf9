#include "media/light/shadow_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/base/parallel.h"
#include "core/integrators/ray_panels.h"
#include "media/light/lit_edges.h"

namespace uw {

namespace {

// Margin that contains a whole cell from any direction in it: its diagonal, doubled.
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
    // Contains all samples of the cells that the beam touches.
    const DirectionCone wide = beam_.widened(k_beam_margin_texels * 2.0 / n);
    Grid2D<float> depth(padded, padded, DepthPyramid::k_untraced);
    std::atomic<std::uint64_t> traced = 0;
    parallel_for(static_cast<std::size_t>(padded), [&](std::size_t row) {
        thread_local std::vector<Vector3> directions;
        thread_local std::vector<double> hits;
        thread_local std::vector<std::size_t> columns;
        directions.clear();
        columns.clear();
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

    void run(const Interval& stretch) {
        edges_.set_stretch(stretch);
        thread_local std::vector<FaceSegment> segments;
        split_by_face(ray_, map_.lamp_, stretch, segments);
        for (const FaceSegment& segment : segments) {
            face_ = CubeFace(segment.face);
            pyramid_ = &map_.faces_[static_cast<std::size_t>(segment.face)];
            if (pyramid_->empty()) continue;  // outside the beam, if only by rounding
            descend(project(segment.stretch.begin), project(segment.stretch.end));
        }
    }

    void append(const Interval& interval) { edges_.append(interval); }

  private:
    struct FromLamp {
        Point3 lamp;
        const Point3& operator()(const Point3& /*x*/) const { return lamp; }
    };
    struct MapPoint {
        double s;      // along the ray
        double depth;  // along the face's axis
        double u, v;   // in texels
    };

    MapPoint project(double s) const {
        const Vector3 x = ray_.at(s) - map_.lamp_;
        const double half = 0.5 * map_.resolution_;
        const double depth = face_.depth(x), texels_per_metre = half / depth;
        return {s, depth, half + x[face_.u_axis] * texels_per_metre,
                half + x[face_.v_axis] * texels_per_metre};
    }

    void descend(const MapPoint& a, const MapPoint& b) {
        const DepthRange range = bound(a, b);
        if (std::max(a.depth, b.depth) * (1 + k_margin) < range.nearest)
            edges_.append({a.s, b.s});
        else if (std::min(a.depth, b.depth) > range.farthest * (1 + k_margin))
            return;
        else if (std::max(std::abs(a.u - b.u), std::abs(a.v - b.v)) <= 1.0 &&
                 std::max(a.depth, b.depth) < 2 * std::min(a.depth, b.depth))
            resolve(a.s, b.s);
        else {
            // Bisects on the face if the interval is long there, else in depth.
            const bool far_on_face = std::max(std::abs(a.u - b.u), std::abs(a.v - b.v)) > 1.0;
            const MapPoint middle =
                project(far_on_face ? (a.s * b.depth + b.s * a.depth) / (a.depth + b.depth)
                                    : 0.5 * (a.s + b.s));
            descend(a, middle);
            descend(middle, b);
        }
    }

    // Nearest and farthest surface over the texels that the interval touches.
    DepthRange bound(const MapPoint& a, const MapPoint& b) const {
        const auto texel = [&](double t) {  // the cell between the samples around t
            return std::clamp(static_cast<int>(std::floor(t + 0.5)), 0, map_.resolution_);
        };
        return pyramid_->bound(texel(std::min(a.u, b.u)), texel(std::min(a.v, b.v)),
                               texel(std::max(a.u, b.u)), texel(std::max(a.v, b.v)));
    }

    // An interval of at most a texel that the map cannot decide.
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

void ShadowMap::lit_intervals(const Ray& ray, const Interval& stretch,
                              std::vector<Interval>& lit) const {
    lit.clear();
    if (!(stretch.length() > 0)) return;
    if (surfaces_->empty()) {
        lit.push_back(stretch);
        return;
    }
    Search search(*this, ray, lit);
    // At the lamp's position no direction is defined; points this close count as lit.
    const double foot = glm::dot(lamp_ - ray.origin, ray.direction);
    const double offset = distance(lamp_, ray.at(foot));
    const double half =
        offset < k_lamp_radius ? std::sqrt(k_lamp_radius * k_lamp_radius - offset * offset) : 0.0;
    const Interval core{std::clamp(foot - half, stretch.begin, stretch.end),
                        std::clamp(foot + half, stretch.begin, stretch.end)};
    if (half == 0 || core.length() == 0) {
        search.run(stretch);
        return;
    }
    search.run({stretch.begin, core.begin});
    search.append(core);
    search.run({core.end, stretch.end});
}

}  // namespace uw
