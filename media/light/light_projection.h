#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/base/ray.h"
#include "core/light/lamp.h"

namespace uw {

/// The corners of a box.
inline std::array<Point3, 8> corners(const Bounds& b) {
    std::array<Point3, 8> result;
    for (std::size_t i = 0; i < 8; ++i)
        result[i] = {(i & 1) != 0 ? b.max.x : b.min.x, (i & 2) != 0 ? b.max.y : b.min.y,
                     (i & 4) != 0 ? b.max.z : b.min.z};
    return result;
}

/// Directions around a lamp as the six faces of a cube, by central projection: a straight line in
/// space is a straight line on a face. Face 2a + 0 faces along +axis a, 2a + 1 along -a.
struct CubeFace {
    int axis = 0;                // the face's major axis: 0, 1, 2
    int u_axis = 1, v_axis = 2;  // the two after it
    double sign = 1;             // direction along the major axis

    explicit CubeFace(int index)
        : axis(index / 2),
          u_axis((axis + 1) % 3),
          v_axis((axis + 2) % 3),
          sign(index % 2 == 0 ? 1.0 : -1.0) {}

    /// Depth of `v` along the face's axis; `v` projects onto the face only if this is > 0.
    double depth(const Vector3& v) const { return sign * v[axis]; }
    double u(const Vector3& v) const { return v[u_axis] / depth(v); }
    double v(const Vector3& w) const { return w[v_axis] / depth(w); }

    /// The direction (of depth 1, not unit length) of the face's point (u, v).
    Vector3 direction(double u_on_face, double v_on_face) const {
        Vector3 d(0.0);
        d[axis] = sign;
        d[u_axis] = u_on_face;
        d[v_axis] = v_on_face;
        return d;
    }
};

/// Index of the face onto which the direction `v` projects; |u|, |v| <= 1 there.
inline int cube_face_of(const Vector3& v) {
    const double x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
    const int axis = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
    return 2 * axis + (v[axis] < 0 ? 1 : 0);
}

/// A segment of a ray that projects onto one face.
struct FaceSegment {
    int face = 0;
    Interval interval;
};

/// Splits [begin, end] of `ray` where it crosses from face to face around `center`. Ascending,
/// without gaps.
void split_by_face(const Ray& ray, const Point3& center, const Interval& interval,
                   std::vector<FaceSegment>& segments);

/// A rectangle of directions on one cube face, within [-1, 1]^2.
struct FaceRectangle {
    double u_min = 1, u_max = -1;
    double v_min = 1, v_max = -1;

    bool empty() const { return u_min > u_max || v_min > v_max; }
};

/// The smallest rectangle on `face` that contains all directions from `center` that hit `box`: the
/// box clipped to the pyramid of the face and projected. Empty if none does; the whole face if
/// `center` lies in the box.
FaceRectangle project_box(const Bounds& box, const Point3& center, const CubeFace& face);

/// The integral over the directions of `rectangle`, du dv, of the length inside `box` of their rays
/// from `center` [m].
double integrate_chords(const Bounds& box, const Point3& center, const CubeFace& face,
                        const FaceRectangle& rectangle);

/// A point in the coordinates of parallel light.
struct LightPoint {
    double u = 0, v = 0;  // across the light [m]
    double depth = 0;     // along it [m]
};

/// The coordinates of a sun's light: a straight ray is a straight line in them, too.
class LightFrame {
  public:
    explicit LightFrame(const Sunlight& sun) : sun_(sun) {
        const Vector3& d = sun.direction;
        const Vector3 least = std::abs(d.x) < 0.6 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
        across_ = glm::normalize(glm::cross(d, least));
        down_ = glm::cross(d, across_);
    }

    const Sunlight& sun() const { return sun_; }
    LightPoint point(const Point3& x) const {
        const Vector3 v = x - sun_.surface.point;
        return {glm::dot(v, across_), glm::dot(v, down_), glm::dot(v, sun_.direction)};
    }
    /// The change of a point's coordinates per metre along a ray.
    LightPoint rates(const Vector3& direction) const {
        return {glm::dot(direction, across_), glm::dot(direction, down_),
                glm::dot(direction, sun_.direction)};
    }
    Point3 world(const LightPoint& p) const {
        return sun_.surface.point + (p.u * across_ + p.v * down_ + p.depth * sun_.direction);
    }
    /// The depth at which the light at (u, v) enters the water.
    double entry_depth(double u, double v) const { return -sun_.length_to(world({u, v, 0})); }

  private:
    Sunlight sun_;
    Vector3 across_{}, down_{};
};

/// A square across a sun's light.
struct LightSquare {
    double u = 0, v = 0;  // its centre
    double half = 0;      // half of an edge [m]

    friend bool operator==(const LightSquare&, const LightSquare&) = default;
};

/// The part of `interval` of a ray that starts at `begin` and changes by `rates` in which it lies
/// within `half_u` and `half_v` of (u, v); empty if it misses that.
inline Interval inside(const LightPoint& begin, const LightPoint& rates, const Interval& interval,
                       const LightPoint& middle, double half_u, double half_v) {
    Interval part = interval;
    const auto clip = [&](double offset, double rate, double half) {
        if (rate == 0) {
            if (std::abs(offset) > half) part.end = part.begin;
            return;
        }
        const double a = (-half - offset) / rate, b = (half - offset) / rate;
        part.begin = std::max(part.begin, std::min(a, b));
        part.end = std::min(part.end, std::max(a, b));
    };
    clip(begin.u - middle.u, rates.u, half_u);
    clip(begin.v - middle.v, rates.v, half_v);
    return part;
}

}  // namespace uw
