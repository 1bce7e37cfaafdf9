#pragma once

#include <array>
#include <cstddef>

#include "core/base/ray.h"
#include "core/base/vector_math.h"

namespace uw {

/// A straight line in lattice space: p(t) = origin + t * direction.
struct LatticeLine {
    Point3 origin;
    Vector3 direction{0, 0, 1};
};

/// The values at the eight corners of an interpolation cell, and the trilinear interpolant between
/// them. All is done for two corners at once, those at y and y + 1.
class CellCorners {
  public:
    using Pair = double __attribute__((vector_size(16)));  // at y and y + 1
    using Four = float __attribute__((vector_size(16)));   // at (x, y), (x, y+1), (x+1, y), ...

    CellCorners() = default;
    CellCorners(const Four& at_z, const Four& at_next_z) {
        for (std::size_t i = 0; i < 2; ++i) {
            const Pair low{double(at_z[2 * i]), double(at_z[2 * i + 1])};
            const Pair high{double(at_next_z[2 * i]), double(at_next_z[2 * i + 1])};
            at_[i] = low;
            rise_[i] = high - low;
        }
    }

    /// The value at a point of the cell, 0 to 1 on each axis.
    double at(const Vector3& p) const {
        const Pair near = at_[0] + p.z * rise_[0];
        const Pair row = near + p.x * (at_[1] + p.z * rise_[1] - near);
        return row[0] + p.y * (row[1] - row[0]);
    }

    /// The mean along a straight piece with the middle `p`, whose extents (x, y, z) have the
    /// products yz, xz and xy of twelve times `products`. For a trilinear function that is its
    /// value in the middle plus a term of its mixed derivatives.
    double mean(const Vector3& p, const Vector3& products) const {
        const Pair near = at_[0] + p.z * rise_[0];
        const Pair along_x = at_[1] + p.z * rise_[1] - near;
        const Pair row = near + p.x * along_x;
        const Pair rise_along_x = rise_[1] - rise_[0];
        const Pair rise = rise_[0] + p.x * rise_along_x;
        const double xz = rise_along_x[0] + p.y * (rise_along_x[1] - rise_along_x[0]);
        return row[0] + p.y * (row[1] - row[0]) + products.x * (rise[1] - rise[0]) +
               products.y * xz + products.z * (along_x[1] - along_x[0]);
    }

    bool zero() const {
        for (std::size_t i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                if (at_[i][j] != 0 || rise_[i][j] != 0) return false;
        return true;
    }

  private:
    std::array<Pair, 2> at_{}, rise_{};  // at x and x + 1: at z, and what is added up to z + 1
};

}  // namespace uw
