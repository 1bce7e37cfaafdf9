#include "core/meshes/polygon.h"

#include <cmath>

#include "core/base/vec.h"

namespace uw {
namespace {

constexpr std::size_t k_max_ear_corners = 1000;

struct Corner {
    std::uint32_t vertex = 0;
    glm::dvec2 at{0.0};  // in the polygon's dominant plane, counter-clockwise
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
    std::vector<Corner> flat(corners.size());
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vector3 p = position(k) - origin;
        flat[k] = {corners[k], {p[first], area[drop] < 0 ? -p[second] : p[second]}};
    }
    return flat;
}

bool is_ear(const std::vector<Corner>& polygon, std::size_t tip) {
    const std::size_t n = polygon.size();
    const std::size_t before = (tip + n - 1) % n, after = (tip + 1) % n;
    const glm::dvec2 a = polygon[before].at, b = polygon[tip].at, c = polygon[after].at;
    if (!(cross(b - a, c - b) > 0)) return false;
    for (std::size_t k = 0; k < n; ++k) {
        if (k == before || k == tip || k == after) continue;
        const glm::dvec2 p = polygon[k].at;
        // The polygon may touch itself at a repeated corner (a bridge to a hole).
        if (p == a || p == b || p == c) continue;
        if (cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0) {
            return false;
        }
    }
    return true;
}

}  // namespace

void triangulate_polygon(std::span<const std::uint32_t> corners, std::span<const float> positions,
                         std::vector<std::uint32_t>& triangles) {
    if (corners.size() < 3) return;
    if (corners.size() == 3 || corners.size() > k_max_ear_corners) {
        for (std::size_t k = 2; k < corners.size(); ++k) {
            triangles.insert(triangles.end(), {corners[0], corners[k - 1], corners[k]});
        }
        return;
    }
    std::vector<Corner> polygon = flattened(corners, positions);
    std::size_t tip = 1;
    while (polygon.size() > 3) {
        std::size_t tried = 0;
        while (tried < polygon.size() && !is_ear(polygon, tip % polygon.size())) {
            ++tip;
            ++tried;
        }
        // A polygon that intersects itself or has no area may have no ear; a fan is as good as
        // anything.
        if (tried == polygon.size()) break;
        const std::size_t n = polygon.size(), cut = tip % n;
        triangles.insert(triangles.end(), {polygon[(cut + n - 1) % n].vertex, polygon[cut].vertex,
                                           polygon[(cut + 1) % n].vertex});
        polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(cut));
        tip = cut;
    }
    for (std::size_t k = 2; k < polygon.size(); ++k) {
        triangles.insert(triangles.end(),
                         {polygon[0].vertex, polygon[k - 1].vertex, polygon[k].vertex});
    }
}

}  // namespace uw
