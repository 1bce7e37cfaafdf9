#include "core/motion/rotation.h"

#include <array>
#include <cmath>

namespace uw {

Rotation Rotation::operator*(const Rotation& o) const {
    return {w * o.w - x * o.x - y * o.y - z * o.z, w * o.x + x * o.w + y * o.z - z * o.y,
            w * o.y - x * o.z + y * o.w + z * o.x, w * o.z + x * o.y - y * o.x + z * o.w};
}

Matrix3 Rotation::matrix() const {
    // Columns.
    return Matrix3(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),  //
                   2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),  //
                   2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y));
}

Rotation normalised(const Rotation& q) {
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return {q.w / length, q.x / length, q.y / length, q.z / length};
}

Rotation rotation_of(const Matrix3& m) {
    // Four times the products of the components with one another; the largest square comes first,
    // so that nothing small is divided by.
    const double trace = m[0][0] + m[1][1] + m[2][2];
    const double yz = m[1][2] - m[2][1], zx = m[2][0] - m[0][2], xy = m[0][1] - m[1][0];
    const std::array<double, 4> squares{1 + trace, 1 + 2 * m[0][0] - trace, 1 + 2 * m[1][1] - trace,
                                        1 + 2 * m[2][2] - trace};
    std::size_t largest = 0;
    for (std::size_t k = 1; k < 4; ++k)
        if (squares[k] > squares[largest]) largest = k;
    const double s01 = m[0][1] + m[1][0], s02 = m[0][2] + m[2][0], s12 = m[1][2] + m[2][1];
    switch (largest) {
        case 0:
            return normalised({squares[0], yz, zx, xy});
        case 1:
            return normalised({yz, squares[1], s01, s02});
        case 2:
            return normalised({zx, s01, squares[2], s12});
        default:
            return normalised({xy, s02, s12, squares[3]});
    }
}

Rotation rotation_by(const Vector3& v) {
    const double angle = glm::length(v);
    // sin(angle/2)/angle; below the limit its series is exact to rounding.
    const double share = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
    return {std::cos(angle / 2), share * v.x, share * v.y, share * v.z};
}

Vector3 rotation_vector(const Rotation& q) {
    const double sign = q.w < 0 ? -1 : 1;
    const Vector3 imaginary(sign * q.x, sign * q.y, sign * q.z);
    const double sine = glm::length(imaginary);
    if (sine == 0) return Vector3(0.0);
    return imaginary * (2 * std::atan2(sine, sign * q.w) / sine);
}

}  // namespace uw
