#include "media/volumes/velocity_field.h"

#include <fmt/format.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "media/volumes/grid_bricks.h"
#include "media/volumes/vdb_header.h"
#include "media/volumes/vdb_stream.h"

namespace uw {
namespace {

constexpr std::size_t k_all_at_once = std::numeric_limits<std::size_t>::max();
constexpr double k_blender_voxels_per_second = 2.5;

openvdb::GridBase::Ptr read_whole(const VdbHeader& header, const GridSummary& grid,
                                  const MotionDesc& motion) {
    openvdb::GridBase::Ptr whole;
    read_guarded(describe_grid_place(header, grid, motion.where), [&] {
        read_slabs(header, grid, k_all_at_once, motion.where,
                   [&](const openvdb::GridBase::Ptr& slab) { whole = slab; });
        if (!whole->transform().isLinear())
            throw std::runtime_error("its transform is not affine; resample it to an affine one");
    });
    return whole;
}

openvdb::Vec3SGrid::Ptr read_vectors(const VdbHeader& header, const GridSummary& grid,
                                     const MotionDesc& motion) {
    if (grid.value_type == "vec3s")
        return openvdb::gridPtrCast<openvdb::Vec3SGrid>(read_whole(header, grid, motion));
    throw InputError(fmt::format(
        "{}: grid '{}' has values of type {}; velocity is one grid of vectors (vec3s), or three of "
        "floats: [vel.x, vel.y, vel.z] ('{}' has {})",
        motion.where, grid.name, grid.value_type, header.file.string(), header.describe_grids()));
}

openvdb::FloatGrid::Ptr read_numbers(const VdbHeader& header, const GridSummary& grid,
                                     const MotionDesc& motion) {
    if (grid.value_type == "float" || grid.value_type == "double")
        return to_float(read_whole(header, grid, motion));
    throw InputError(fmt::format(
        "{}: grid '{}' has values of type {}; each of the three must be a grid of floats",
        motion.where, grid.name, grid.value_type));
}

/// Invalid velocities count as zero.
template <class T>
T finite(T value) {
    return std::isfinite(value) ? value : T(0);
}

}  // namespace

VelocityField::VelocityField(const MotionDesc& motion, Centering centering)
    : shift_(centering == Centering::cell ? 0.5 : 0.0) {
    const VdbHeader header = read_vdb_header(motion.file, motion.where);
    if (motion.grids.size() == 1) {
        const GridSummary& grid = grid_called(header, motion.grids[0], motion.where);
        staggered_ = grid.grid_class == "staggered";
        vectors_ = read_vectors(header, grid, motion);
        for (auto value = vectors_->beginValueAll(); value; ++value) {
            const openvdb::Vec3f v = *value;
            value.setValue({finite(v.x()), finite(v.y()), finite(v.z())});
        }
    } else {
        for (const std::string& name : motion.grids)
            numbers_.push_back(
                read_numbers(header, grid_called(header, name, motion.where), motion));
        for (const openvdb::FloatGrid::Ptr& grid : numbers_)
            for (auto value = grid->beginValueAll(); value; ++value) value.setValue(finite(*value));
    }
    if (motion.scale) {
        scale_ = *motion.scale;
    } else if (header.from_blender_fluid()) {
        scale_ = k_blender_voxels_per_second * first_grid().voxelSize().x();
    }
    const auto take_box = [&](const openvdb::GridBase& grid) {
        openvdb::CoordBBox box;
        if (grid.baseTree().evalActiveVoxelBoundingBox(box)) box_.expand(box);
    };
    if (vectors_) take_box(*vectors_);
    for (const openvdb::FloatGrid::Ptr& grid : numbers_) take_box(*grid);
}

const openvdb::GridBase& VelocityField::first_grid() const {
    return vectors_ ? static_cast<const openvdb::GridBase&>(*vectors_) : *numbers_[0];
}

VelocityField::Sampler::Sampler(const VelocityField& field) : field_(field) {
    if (field.vectors_) vectors_.push_back(field.vectors_->getConstAccessor());
    for (const openvdb::FloatGrid::Ptr& grid : field.numbers_)
        numbers_.push_back(grid->getConstAccessor());
}

openvdb::Vec3d VelocityField::Sampler::operator()(const openvdb::Vec3d& x) const {
    const openvdb::Vec3d shift(field_.shift_);
    if (!vectors_.empty()) {
        const openvdb::Vec3d at = field_.vectors_->transform().worldToIndex(x) - shift;
        const openvdb::Vec3f v = field_.staggered_
                                     ? openvdb::tools::StaggeredBoxSampler::sample(vectors_[0], at)
                                     : openvdb::tools::BoxSampler::sample(vectors_[0], at);
        return field_.scale_ * openvdb::Vec3d(v);
    }
    openvdb::Vec3d v;
    for (int c = 0; c < 3; ++c) {
        const auto n = static_cast<std::size_t>(c);
        const openvdb::Vec3d at = field_.numbers_[n]->transform().worldToIndex(x) - shift;
        v[c] = field_.scale_ *
               static_cast<double>(openvdb::tools::BoxSampler::sample(numbers_[n], at));
    }
    return v;
}

Matrix3 VelocityField::Sampler::gradient(const openvdb::Vec3d& x) const {
    const openvdb::math::Transform& transform = field_.first_grid().transform();
    const openvdb::Vec3d shift(field_.shift_);
    const openvdb::Vec3d at = transform.worldToIndex(x) - shift;
    Matrix3 along(0.0);  // the grid's own axes [m/s per voxel]
    Matrix3 file_from_index(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Vec3d unit(0, 0, 0);
        unit[axis] = 1;
        const openvdb::Vec3d edge =
            transform.indexToWorld(unit) - transform.indexToWorld(openvdb::Vec3d(0, 0, 0));
        file_from_index[axis] = {edge.x(), edge.y(), edge.z()};
        if (field_.box_.empty()) continue;
        const double low = field_.box_.min()[axis], high = field_.box_.max()[axis];
        openvdb::Vec3d before = at, behind = at;
        before[axis] = std::clamp(at[axis] - 1, low, high);
        behind[axis] = std::clamp(at[axis] + 1, low, high);
        const double voxels = behind[axis] - before[axis];
        if (!(voxels > 0)) continue;
        const openvdb::Vec3d change = (*this)(transform.indexToWorld(behind + shift)) -
                                      (*this)(transform.indexToWorld(before + shift));
        along[axis] = Vector3(change.x(), change.y(), change.z()) / voxels;
    }
    return along * glm::inverse(file_from_index);
}

openvdb::Vec3d VelocityField::largest(const Matrix3& linear) const {
    openvdb::Vec3d bound(0, 0, 0);
    const auto take = [&](const Vector3& v) {
        const Vector3 mapped = linear * v;
        for (int c = 0; c < 3; ++c) bound[c] = std::max(bound[c], std::abs(scale_ * mapped[c]));
    };
    if (vectors_) {
        // Staggered components of different voxels combine at one point.
        Vector3 most(0.0);
        for (auto value = vectors_->cbeginValueAll(); value; ++value) {
            const openvdb::Vec3f v = *value;
            if (!staggered_) take({v.x(), v.y(), v.z()});
            for (int c = 0; c < 3; ++c)
                most[c] = std::max(most[c], std::abs(static_cast<double>(v[c])));
        }
        if (!staggered_) return bound;
        for (int c = 0; c < 3; ++c)
            for (int axis = 0; axis < 3; ++axis)
                bound[c] += std::abs(scale_) * std::abs(linear[axis][c]) * most[axis];
        return bound;
    }
    for (int axis = 0; axis < 3; ++axis) {
        double most = 0;
        for (auto value = numbers_[static_cast<std::size_t>(axis)]->cbeginValueAll(); value;
             ++value)
            most = std::max(most, std::abs(static_cast<double>(*value)));
        for (int c = 0; c < 3; ++c) bound[c] += std::abs(scale_) * std::abs(linear[axis][c]) * most;
    }
    return bound;
}

}  // namespace uw
