#include "render/derivatives/voxel_gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/numerics.h"

namespace uw {

VoxelGradient::VoxelGradient(const GridVolume& grid, const std::array<std::size_t, 3>& size)
    : grid_(grid), size_(size), values_(size[0] * size[1] * size[2]) {}

double VoxelGradient::of_value(std::span<const double> weights) const {
    double sum = 0;
    for (const GridLoad& load : grid_.loads())
        sum += load.per_unit * weights[static_cast<std::size_t>(load.constituent)];
    return sum;
}

void VoxelGradient::add(const Point3& lattice, double weight) {
    std::array<long, 3> cell{};
    Vector3 t;
    for (int axis = 0; axis < 3; ++axis) {
        const double floor = std::floor(lattice[axis]);
        cell[static_cast<std::size_t>(axis)] = static_cast<long>(floor);
        t[axis] = lattice[axis] - floor;
    }
    for (unsigned corner = 0; corner < 8; ++corner) {
        double corner_weight = weight;
        std::size_t place = 0;
        bool is_inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool is_next = (corner >> axis & 1U) != 0;
            const double along = t[static_cast<int>(axis)];
            corner_weight *= is_next ? along : 1 - along;
            const long index = cell[axis] + (is_next ? 1 : 0);
            is_inside = is_inside && index >= 0 && index < static_cast<long>(size_[axis]);
            if (is_inside) place = place * size_[axis] + static_cast<std::size_t>(index);
        }
        if (is_inside) values_[place] += corner_weight;
    }
}

void VoxelGradient::add_sample(const Point3& x, std::span<const double> weights) {
    const double weight = of_value(weights);
    if (weight == 0) return;
    const Point3 p = grid_.lattice_point(x);
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] <= -1 || p[axis] >= static_cast<double>(size_[static_cast<std::size_t>(axis)]))
            return;
    add(p, weight);
}

void VoxelGradient::add_column(const Point3& a, const Point3& b, std::span<const double> weights) {
    const double length = distance(a, b);
    const double weight = of_value(weights) * length;
    if (weight == 0) return;
    const LatticeLine line = grid_.lattice_line(a, b - a);
    // The part of the line within one cell of the values, where they contribute.
    double begin = 0, end = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double from = line.origin[axis], along = line.direction[axis];
        const double last = static_cast<double>(size_[static_cast<std::size_t>(axis)]);
        if (along == 0) {
            if (from <= -1 || from >= last) return;
            continue;
        }
        const double t0 = (-1 - from) / along, t1 = (last - from) / along;
        begin = std::max(begin, std::min(t0, t1));
        end = std::min(end, std::max(t0, t1));
    }
    // From one plane between cells to the next.
    constexpr double k_far_away = std::numeric_limits<double>::infinity();
    while (begin < end) {
        double next = end;
        for (int axis = 0; axis < 3; ++axis) {
            const double along = line.direction[axis];
            if (along == 0) continue;
            const double here = line.origin[axis] + begin * along;
            double plane = along > 0 ? std::floor(here) + 1 : std::ceil(here) - 1;
            double t = (plane - line.origin[axis]) / along;
            // Where `begin` is a plane, to rounding.
            if (t <= begin + 1e-12 * (1 + std::abs(begin)))
                t = (plane + (along > 0 ? 1 : -1) - line.origin[axis]) / along;
            next = std::min(next, t > begin ? t : k_far_away);
        }
        for (const QuadratureNode& node : gauss_legendre(2))
            add(line.origin + (begin + node.position * (next - begin)) * line.direction,
                weight * node.weight * (next - begin));
        begin = next;
    }
}

}  // namespace uw
