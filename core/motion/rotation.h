#pragma once

#include "core/base/vec.h"

namespace uw {

/// A rotation as a unit quaternion w + xi + yj + zk; q and -q are the same rotation.
struct Rotation {
    double w = 1, x = 0, y = 0, z = 0;

    /// The rotation that applies `other` first: a_from_c = a_from_b * b_from_c.
    Rotation operator*(const Rotation& other) const;
    Rotation inverse() const { return {w, -x, -y, -z}; }
    Matrix3 matrix() const;

    friend bool operator==(const Rotation&, const Rotation&) = default;
};

/// The rotation by a rotation matrix (Shepperd 1978), or, of one that is off by rounding, one as
/// close.
Rotation rotation_of(const Matrix3& matrix);

/// The rotation of any quaternion but 0, brought to length 1.
Rotation normalised(const Rotation& q);

/// The rotation about the axis of `v` by its length [rad].
Rotation rotation_by(const Vector3& v);

/// The shortest `v` for which rotation_by(v) is `rotation`: at most pi long.
Vector3 rotation_vector(const Rotation& rotation);

}  // namespace uw
