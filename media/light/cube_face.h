#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/base/ray.h"

namespace uw {

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
    Interval stretch;
};

/// Splits [begin, end] of `ray` where it crosses from face to face around `center`. Ascending,
/// without gaps.
void split_by_face(const Ray& ray, const Point3& center, const Interval& stretch,
                   std::vector<FaceSegment>& segments);

}  // namespace uw
