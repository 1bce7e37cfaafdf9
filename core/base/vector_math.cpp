#include "core/base/vector_math.h"

#include <cmath>

namespace uw {

Affine Affine::scale(const Vector3& factors) {
    Matrix3 m(0.0);
    for (int axis = 0; axis < 3; ++axis) m[axis][axis] = factors[axis];
    return {m, Vector3(0.0)};
}

Affine Affine::rotation_xyz_degrees(const Vector3& angles) {
    const Vector3 radians = glm::radians(angles);
    const double cx = std::cos(radians.x), sx = std::sin(radians.x);
    const double cy = std::cos(radians.y), sy = std::sin(radians.y);
    const double cz = std::cos(radians.z), sz = std::sin(radians.z);
    // GLM matrices are given column by column.
    const Matrix3 about_x(1, 0, 0, 0, cx, sx, 0, -sx, cx);
    const Matrix3 about_y(cy, 0, -sy, 0, 1, 0, sy, 0, cy);
    const Matrix3 about_z(cz, sz, 0, -sz, cz, 0, 0, 0, 1);
    return {about_z * about_y * about_x, Vector3(0.0)};
}

Vector3 Affine::apply_to_normal(const Vector3& n) const {
    return glm::normalize(glm::transpose(glm::inverse(linear_)) * n);
}

Affine Affine::operator*(const Affine& other) const {
    return {linear_ * other.linear_, linear_ * other.translation_ + translation_};
}

Affine Affine::inverse() const {
    const Matrix3 inverse_linear = glm::inverse(linear_);
    return {inverse_linear, -(inverse_linear * translation_)};
}

}  // namespace uw
