#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace uw {

/// A degree [rad].
inline constexpr double k_degree = std::numbers::pi / 180;

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

/// The angle between two vectors of any lengths [rad], 0 to pi: exact near both ends, where an
/// arc cosine is not.
inline double angle_between(const Vector3& a, const Vector3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// An affine map between two named spaces; name variables `target_from_source`.
class Affine {
  public:
    Affine() = default;
    Affine(const Matrix3& linear, const Vector3& translation)
        : linear_(linear), translation_(translation) {}

    static Affine translation(const Vector3& offset) { return {Matrix3(1.0), offset}; }
    static Affine scale(const Vector3& factors);
    /// Rotation by Euler angles in degrees, about the fixed axes x, then y, then z.
    static Affine rotation_xyz_degrees(const Vector3& angles);

    const Matrix3& linear() const { return linear_; }
    const Vector3& offset() const { return translation_; }

    Point3 operator*(const Point3& p) const {
        return at_origin_plus(linear_ * from_origin(p) + translation_);
    }
    /// Maps a displacement (no translation, length changes with the map).
    Vector3 apply_to_vector(const Vector3& v) const { return linear_ * v; }
    /// Maps a surface normal by the inverse transpose; the result is unit.
    Vector3 apply_to_normal(const Vector3& n) const;
    /// The map that applies `other` first: a_from_c = a_from_b * b_from_c.
    Affine operator*(const Affine& other) const;
    double determinant() const { return glm::determinant(linear_); }
    /// The inverse map. Precondition: determinant() != 0.
    Affine inverse() const;

    friend bool operator==(const Affine&, const Affine&) = default;

  private:
    Matrix3 linear_{1.0};
    Vector3 translation_{0.0};
};

}  // namespace uw
