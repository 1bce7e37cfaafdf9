#pragma once

#include "core/base/vec.h"

namespace uw {

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
