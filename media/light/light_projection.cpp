#include "media/light/light_projection.h"

#include <algorithm>

namespace uw {

void split_by_face(const Ray& ray, const Point3& center, const Interval& interval,
                   std::vector<FaceSegment>& segments) {
    segments.clear();
    segments.reserve(7);  // most of what a line crosses
    const Vector3 o = ray.origin - center;
    const Vector3& d = ray.direction;
    std::array<double, 8> cuts{interval.begin, interval.end};  // ascending
    std::size_t count = 2;
    // The face changes where two components are equal in size.
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3;
        for (const double sign : {1.0, -1.0}) {
            const double s = -(o[a] + sign * o[b]) / (d[a] + sign * d[b]);
            if (!(s > interval.begin && s < interval.end)) continue;
            const auto used = cuts.begin() + static_cast<std::ptrdiff_t>(count++);
            *used = s;
            std::rotate(std::upper_bound(cuts.begin(), used, s), used, used + 1);
        }
    }
    for (std::size_t i = 0; i + 1 < count; ++i) {
        if (cuts[i + 1] <= cuts[i]) continue;
        const int face = cube_face_of(ray.at(0.5 * (cuts[i] + cuts[i + 1])) - center);
        if (!segments.empty() && segments.back().face == face)
            segments.back().interval.end = cuts[i + 1];
        else
            segments.push_back({face, {cuts[i], cuts[i + 1]}});
    }
}

namespace {

using Polygon = std::vector<Vector3>;  // corners relative to the centre of projection

bool contains(const Bounds& b, const Point3& p) {
    return p.x >= b.min.x && p.x <= b.max.x && p.y >= b.min.y && p.y <= b.max.y && p.z >= b.min.z &&
           p.z <= b.max.z;
}

// The side of the box on which coordinate `axis` is at its `side` (0: least, 1: largest).
Polygon box_side(const Bounds& box, const Point3& center, int axis, int side) {
    Polygon polygon;
    for (const auto& [high_a, high_b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        Point3 corner;
        corner[axis] = side != 0 ? box.max[axis] : box.min[axis];
        corner[a] = high_a != 0 ? box.max[a] : box.min[a];
        corner[b] = high_b != 0 ? box.max[b] : box.min[b];
        polygon.push_back(corner - center);
    }
    return polygon;
}

// Clips a polygon to where `distance` is not negative (Sutherland and Hodgman).
template <class Distance>
Polygon clip(const Polygon& polygon, const Distance& distance) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vector3& a = polygon[i];
        const Vector3& b = polygon[(i + 1) % polygon.size()];
        const double da = distance(a), db = distance(b);
        if (da >= 0) kept.push_back(a);
        if ((da >= 0) != (db >= 0)) kept.push_back(a + (da / (da - db)) * (b - a));
    }
    return kept;
}

double chord(const Bounds& box, const Point3& origin, const Vector3& direction) {
    double begin = 0, end = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min[axis] - origin[axis]) / direction[axis];
        const double b = (box.max[axis] - origin[axis]) / direction[axis];
        if (direction[axis] == 0) {
            if (origin[axis] < box.min[axis] || origin[axis] > box.max[axis]) return 0;
            continue;
        }
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return std::max(0.0, end - begin);
}

}  // namespace

FaceRectangle project_box(const Bounds& box, const Point3& center, const CubeFace& face) {
    if (contains(box, center)) return {-1, 1, -1, 1};
    FaceRectangle rectangle;
    const int a = (face.axis + 1) % 3, b = (face.axis + 2) % 3;
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = 0; side < 2; ++side) {
            Polygon polygon = box_side(box, center, axis, side);
            polygon = clip(polygon, [&](const Vector3& p) { return face.depth(p) - p[a]; });
            polygon = clip(polygon, [&](const Vector3& p) { return face.depth(p) + p[a]; });
            polygon = clip(polygon, [&](const Vector3& p) { return face.depth(p) - p[b]; });
            polygon = clip(polygon, [&](const Vector3& p) { return face.depth(p) + p[b]; });
            for (const Vector3& p : polygon) {
                if (face.depth(p) <= 0) continue;
                rectangle.u_min = std::min(rectangle.u_min, face.u(p));
                rectangle.u_max = std::max(rectangle.u_max, face.u(p));
                rectangle.v_min = std::min(rectangle.v_min, face.v(p));
                rectangle.v_max = std::max(rectangle.v_max, face.v(p));
            }
        }
    }
    return rectangle;
}

double integrate_chords(const Bounds& box, const Point3& center, const CubeFace& face,
                        const FaceRectangle& rectangle) {
    constexpr int k_samples =
        32;  // along each side: accurate to a few per cent, enough for a budget
    if (rectangle.empty()) return 0;
    const double du = (rectangle.u_max - rectangle.u_min) / k_samples;
    const double dv = (rectangle.v_max - rectangle.v_min) / k_samples;
    double sum = 0;
    for (int j = 0; j < k_samples; ++j)
        for (int i = 0; i < k_samples; ++i)
            sum += chord(box, center,
                         glm::normalize(face.direction(rectangle.u_min + (i + 0.5) * du,
                                                       rectangle.v_min + (j + 0.5) * dv)));
    return sum * du * dv;
}

}  // namespace uw
