#include "core/geometry/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/vector_math.h"

namespace uw {
namespace {

/// The most corners of a polygon whose remainder may become a fan, whose triangles may overlap,
/// which costs time for each ray.
constexpr std::size_t k_max_fan_corners = 1000;
/// Limit on the steps of the search for ears, of some 15 ns each. Outlines of real objects need
/// some 20 per corner; small polygons are not limited.
constexpr std::size_t k_steps = 100'000, k_steps_per_corner = 200;

struct Corner {
    std::uint32_t vertex = 0;
    glm::dvec2 at{0.0};                 // in the polygon's dominant plane, counter-clockwise
    std::size_t before = 0, after = 0;  // its neighbours among those left
    bool is_left = true;
};

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// Projects the polygon along the largest axis of its area vector (Newell's method).
std::vector<Corner> flattened(std::span<const std::uint32_t> corners,
                              std::span<const float> positions) {
    const auto position = [&](std::size_t k) {
        const std::size_t at = 3 * std::size_t{corners[k % corners.size()]};
        return Vector3(positions[at], positions[at + 1], positions[at + 2]);
    };
    const Vector3 origin = position(0);
    Vector3 area(0.0);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        area += glm::cross(position(k) - origin, position(k + 1) - origin);
    }
    const Vector3 size = glm::abs(area);
    const int drop = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const int first = (drop + 1) % 3, second = (drop + 2) % 3;
    const std::size_t n = corners.size();
    std::vector<Corner> flat(n);
    for (std::size_t k = 0; k < n; ++k) {
        const Vector3 p = position(k) - origin;
        flat[k] = {corners[k],
                   {p[first], area[drop] < 0 ? -p[second] : p[second]},
                   (k + n - 1) % n,
                   (k + 1) % n};
    }
    return flat;
}

/// The corners at which a polygon is not convex, by their place: no other can lie in an ear.
class ReflexCorners {
  public:
    explicit ReflexCorners(const std::vector<Corner>& polygon) : polygon_(polygon) {
        std::vector<std::size_t> reflex;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const glm::dvec2 a = polygon[polygon[k].before].at, b = polygon[k].at;
            if (!(cross(b - a, polygon[polygon[k].after].at - b) > 0)) reflex.push_back(k);
        }
        if (reflex.empty()) return;
        low_ = high_ = polygon[reflex[0]].at;
        for (const std::size_t k : reflex) {
            low_ = glm::min(low_, polygon[k].at);
            high_ = glm::max(high_, polygon[k].at);
        }
        side_ = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(reflex.size()))));
        // Sorted by their cells: each cell's begin, then its corners.
        begins_.assign(side_ * side_ + 1, 0);
        for (const std::size_t k : reflex) ++begins_[cell_of(polygon[k].at) + 1];
        for (std::size_t cell = 1; cell < begins_.size(); ++cell)
            begins_[cell] += begins_[cell - 1];
        corners_.resize(reflex.size());
        std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
        for (const std::size_t k : reflex) corners_[next[cell_of(polygon[k].at)]++] = k;
    }

    /// Whether any of these corners lies in the triangle `ear`, except its own. Adds the steps that
    /// it took to `steps`.
    bool any_within(const Corner& a, const Corner& b, const Corner& c, std::size_t& steps) const {
        if (corners_.empty()) return false;
        const std::size_t first = cell(std::min({a.at.y, b.at.y, c.at.y}), 1);
        const std::size_t last = cell(std::max({a.at.y, b.at.y, c.at.y}), 1);
        for (std::size_t row = first; row <= last; ++row) {
            const auto [x0, x1] = columns_in_row(row, {a.at, b.at, c.at});
            if (x0 > x1) continue;
            const std::size_t begin = begins_[row * side_ + x0];
            const std::size_t end = begins_[row * side_ + x1 + 1];
            steps += 1 + end - begin;
            for (std::size_t k = begin; k < end; ++k) {
                const Corner& other = polygon_[corners_[k]];
                if (other.is_left && is_within(other.at, a.at, b.at, c.at)) return true;
            }
        }
        return false;
    }

  private:
    /// The cells that a triangle touches in one row of them, first and last; thin ones touch few.
    std::pair<std::size_t, std::size_t> columns_in_row(
        std::size_t row, const std::array<glm::dvec2, 3>& triangle) const {
        // Widened by far more than rounding.
        constexpr double k_margin = 1e-6;
        const double height = (high_.y - low_.y) / static_cast<double>(side_);
        const double y0 = low_.y + (static_cast<double>(row) - k_margin) * height;
        const double y1 = y0 + (1 + 2 * k_margin) * height;
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec2 p = triangle[k], q = triangle[(k + 1) % 3];
            const double rise = q.y - p.y;
            for (const double y : {y0, y1, p.y, q.y}) {
                // The first and last cells of a row also contain what lies beyond them.
                const bool is_in_row = (y >= y0 || row == 0) && (y <= y1 || row + 1 == side_);
                if (!is_in_row || !(y >= std::min(p.y, q.y) && y <= std::max(p.y, q.y))) continue;
                const double x = y == p.y   ? p.x
                                 : y == q.y ? q.x
                                            : p.x + (q.x - p.x) * ((y - p.y) / rise);
                least = std::min(least, x);
                most = std::max(most, x);
            }
            if (rise == 0 && least <= most) {
                least = std::min({least, p.x, q.x});
                most = std::max({most, p.x, q.x});
            }
        }
        if (!(least <= most)) return {1, 0};
        const double margin = k_margin * (high_.x - low_.x);
        return {cell(least - margin, 0), cell(most + margin, 0)};
    }
    std::size_t cell(double x, int axis) const {
        const double place = (x - low_[axis]) / (high_[axis] - low_[axis]);
        const double n = static_cast<double>(side_);
        // Also if it is NaN, as for an empty box or invalid corners.
        return place > 0 ? static_cast<std::size_t>(std::min(place * n, n - 1)) : 0;
    }
    std::size_t cell_of(const glm::dvec2& p) const { return cell(p.y, 1) * side_ + cell(p.x, 0); }
    static bool is_within(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b,
                          const glm::dvec2& c) {
        // The polygon may touch itself at a repeated corner (a bridge to a hole).
        if (p == a || p == b || p == c) return false;
        return cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0;
    }

    const std::vector<Corner>& polygon_;
    glm::dvec2 low_{0.0}, high_{0.0};
    std::size_t side_ = 0;
    std::vector<std::size_t> begins_, corners_;
};

}  // namespace

void triangulate_polygon(std::span<const std::uint32_t> corners, std::span<const float> positions,
                         const std::string& name, std::vector<std::uint32_t>& triangles) {
    if (corners.size() < 3) return;
    if (corners.size() == 3) {
        triangles.insert(triangles.end(), corners.begin(), corners.end());
        return;
    }
    const auto fail = [&](const char* why) {
        throw InputError(
            fmt::format("{}: a polygon of {} corners {}; triangulate it where it was made", name,
                        corners.size(), why));
    };
    std::vector<Corner> polygon = flattened(corners, positions);
    const ReflexCorners reflex(polygon);
    std::size_t steps = 0, left = polygon.size(), tip = 1, tried = 0;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        triangles.insert(triangles.end(),
                         {polygon[a].vertex, polygon[b].vertex, polygon[c].vertex});
    };
    // A polygon that intersects itself or has no area may have no ear; a fan is as good as
    // anything.
    while (left > 3 && tried < left) {
        const Corner &b = polygon[tip], &a = polygon[b.before], &c = polygon[b.after];
        if (++steps > k_steps + k_steps_per_corner * corners.size()) fail("is too intricate");
        const bool is_ear =
            cross(b.at - a.at, c.at - b.at) > 0 && !reflex.any_within(a, b, c, steps);
        if (is_ear) {
            add(b.before, tip, b.after);
            polygon[tip].is_left = false;
            polygon[b.before].after = b.after;
            polygon[b.after].before = b.before;
            --left;
        }
        tried = is_ear ? 0 : tried + 1;
        tip = b.after;
    }
    if (left > 3 && corners.size() > k_max_fan_corners) fail("crosses itself");
    const auto first = static_cast<std::size_t>(std::ranges::find(polygon, true, &Corner::is_left) -
                                                polygon.begin());
    for (std::size_t k = polygon[first].after; polygon[k].after != first; k = polygon[k].after)
        add(first, k, polygon[k].after);
}

}  // namespace uw
