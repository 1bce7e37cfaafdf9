#include "media/volumes/grid_volume.h"

#include <utility>

namespace uw {
namespace {

/// World bounds of a lattice box; an affine map takes its corners to those of its image.
Bounds bounds_of_image(const Affine& map, const Bounds& box, double shrink) {
    Bounds image;
    for (unsigned corner = 0; corner < 8; ++corner) {
        Point3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = (corner >> axis & 1U) != 0 ? box.max[axis] - shrink : box.min[axis] + shrink;
        image.extend(map * p);
    }
    return image;
}

}  // namespace

GridVolume::GridVolume(std::vector<NanoGrid> bricks, const Affine& world_from_index,
                       Centering centering, std::vector<GridLoad> loads)
    : bricks_(std::move(bricks)), loads_(std::move(loads)) {
    const double shift = centering == Centering::cell ? 0.5 : 0.0;
    const Affine world_from_lattice = world_from_index * Affine::translation(Vector3(shift));
    lattice_from_world_ = world_from_lattice.inverse();
    const Matrix3& linear = world_from_lattice.linear();
    voxel_size_ = {glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])};
    for (const NanoGrid& brick : bricks_) {
        bounds_.extend(bounds_of_image(world_from_lattice, brick.support(), 0.0));
        voxel_bounds_.extend(bounds_of_image(world_from_lattice, brick.support(), 0.5));
    }
}

GridVolume GridVolume::scaled(double factor) const {
    GridVolume other = *this;
    for (GridLoad& load : other.loads_) load.per_unit *= factor;
    return other;
}

double GridVolume::value(const Point3& x) const {
    const Point3 p = lattice_from_world_ * x;
    double sum = 0;
    for (const NanoGrid& brick : bricks_) sum += brick.sample(p);
    return sum;
}

double GridVolume::column(const Point3& a, const Point3& b) const {
    const LatticeLine line = lattice_line(a, b - a);
    double sum = 0;
    for (const NanoGrid& brick : bricks_) sum += brick.integrate(line);
    return sum * distance(a, b);
}

}  // namespace uw
