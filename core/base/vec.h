#pragma once

#include <glm/glm.hpp>

namespace uw {

/// A displacement, direction or normal. Unit length if its name contains `direction` or `normal`.
using Vector3 = glm::dvec3;
using Matrix3 = glm::dmat3;

/// A position. Points and vectors do not mix: the difference of two points is a vector, and only
/// a vector can be added to a point.
struct Point3 {
    double x = 0;
    double y = 0;
    double z = 0;

    friend bool operator==(const Point3&, const Point3&) = default;
    double operator[](int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }
    double& operator[](int axis) { return axis == 0 ? x : (axis == 1 ? y : z); }
};

inline Point3 operator+(const Point3& p, const Vector3& v) {
    return {p.x + v.x, p.y + v.y, p.z + v.z};
}
inline Point3 operator-(const Point3& p, const Vector3& v) {
    return {p.x - v.x, p.y - v.y, p.z - v.z};
}
inline Vector3 operator-(const Point3& a, const Point3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// The vector from the origin to `p`; the only way to turn a point into a vector.
inline Vector3 from_origin(const Point3& p) {
    return {p.x, p.y, p.z};
}
/// The point displaced by `v` from the origin.
inline Point3 at_origin_plus(const Vector3& v) {
    return {v.x, v.y, v.z};
}

inline double distance(const Point3& a, const Point3& b) {
    return glm::length(a - b);
}

}  // namespace uw
