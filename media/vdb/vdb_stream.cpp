#include "media/vdb/vdb_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "core/base/available_memory.h"
#include "core/base/stop.h"
#include "media/vdb/nvdb_grid.h"
#include "media/vdb/vdb_layout.h"

namespace uw {
namespace {

/// Calls `take(origin)` for every leaf.
void for_each_leaf(const openvdb::GridBase& grid,
                   const std::function<void(const openvdb::Coord&)>& take) {
    grid.apply<ReadableGrids>([&](const auto& typed) {
        for (auto upper = typed.tree().root().cbeginChildOn(); upper; ++upper)
            for (auto lower = upper->cbeginChildOn(); lower; ++lower)
                for (auto leaf = lower->cbeginChildOn(); leaf; ++leaf) take(leaf->origin());
    });
}

std::size_t bytes_of_leaf(const openvdb::GridBase& grid) {
    std::size_t bytes = 0;
    grid.apply<ReadableGrids>([&](const auto& typed) {
        using Tree = typename std::decay_t<decltype(typed)>::TreeType;
        bytes = sizeof(typename Tree::ValueType) * std::size_t{Tree::LeafNodeType::SIZE};
    });
    return bytes;
}

/// What slabs hold at most, if `total` bytes are cut into slabs of about `slab_bytes`.
std::size_t largest_slab(std::size_t total, std::size_t slab_bytes) {
    return std::min(total, std::max(slab_bytes, total / 8));
}

void check_memory(const openvdb::GridBase& grid, std::size_t slab_bytes,
                  const std::string& prefix) {
    const std::size_t leaves = grid.constBaseTree().leafCount();
    const std::size_t total = leaves * bytes_of_leaf(grid);
    // A voxel takes 16 bits in what is kept, and a slab is there twice while it is converted.
    constexpr std::size_t k_kept_bytes_per_leaf = 2 * 512;
    require_memory(static_cast<double>(leaves * k_kept_bytes_per_leaf) +
                       2 * static_cast<double>(largest_slab(total, slab_bytes)),
                   prefix + "it needs", "resample it to larger voxels");
}

/// The boxes into which a grid (topology only) is split for read_slabs; empty: no need to split.
std::vector<openvdb::CoordBBox> cut_into_slabs(const openvdb::GridBase& grid,
                                               std::size_t slab_bytes) {
    const std::size_t leaf_bytes = bytes_of_leaf(grid);
    const std::size_t total = grid.constBaseTree().leafCount() * leaf_bytes;
    if (total <= slab_bytes) return {};
    slab_bytes = largest_slab(total, slab_bytes);

    openvdb::CoordBBox box;
    for_each_leaf(grid, [&](const openvdb::Coord& origin) { box.expand(origin); });
    const std::size_t axis = box.maxExtent();
    std::map<int, std::size_t> leaves_at;
    for_each_leaf(grid, [&](const openvdb::Coord& origin) { ++leaves_at[origin[axis]]; });
    std::vector<openvdb::CoordBBox> slabs{openvdb::CoordBBox::inf()};
    std::size_t bytes = 0;
    for (const auto& [origin, leaves] : leaves_at) {
        if (bytes > 0 && bytes + leaves * leaf_bytes > slab_bytes) {
            slabs.back().max()[axis] = origin - 1;
            slabs.push_back(openvdb::CoordBBox::inf());
            slabs.back().min()[axis] = origin;
            bytes = 0;
        }
        bytes += leaves * leaf_bytes;
    }
    return slabs;
}

}  // namespace

GridStream::GridStream(const VdbHeader& header, const GridSummary& grid, const GridSummary& voxels,
                       const SourceLocation& where)
    : header_(header), grid_(grid), voxels_(voxels), where_(where) {
    if (file_.open(header.file, std::ios::in | std::ios::binary) == nullptr)
        stream_.setstate(std::ios::failbit);
    check_transform(header, grid, where);
    check_transform(header, voxels, where);
    stream_.exceptions(std::ios::failbit | std::ios::badbit);
    metadata_->setFileVersion(header.version);
    metadata_->setLibraryVersion({header.library_major, header.library_minor});
    metadata_->setCompression(voxels.compression);
    metadata_->setHalfFloat(voxels.half);
    metadata_->setSeekable(true);
    openvdb::io::setStreamMetadataPtr(stream_, metadata_, /*transfer=*/true);
}

openvdb::math::Transform::ConstPtr GridStream::read_transform() {
    const auto transform = openvdb::math::Transform::createLinearTransform();
    stream_.seekg(grid_.transform_offset);
    transform->read(stream_);
    return transform;
}

openvdb::GridBase::Ptr GridStream::read_topology() {
    auto grid = openvdb::GridBase::createGrid("Tree_" + voxels_.value_type + "_5_4_3");
    grid->setSaveFloatAsHalf(voxels_.half);
    stream_.seekg(voxels_.transform_offset);
    grid->readTransform(stream_);
    check_layout_once();
    metadata_->setLeaf(0);
    grid->readTopology(stream_);
    const auto blocks = stream_.tellg();
    if (&grid_ != &voxels_) {
        stream_.seekg(grid_.transform_offset);
        grid->readTransform(stream_);
        stream_.seekg(blocks);
    }
    return grid;
}

void GridStream::read_values(openvdb::GridBase& grid) {
    grid.readBuffers(stream_);
}

void GridStream::read_values(openvdb::GridBase& grid, const openvdb::CoordBBox& box) {
    grid.readBuffers(stream_, box);
}

void GridStream::check_layout_once() {
    if (!layout_checked_) check_layout(header_, voxels_, stream_.tellg(), where_);
    layout_checked_ = true;
}

openvdb::math::Transform::ConstPtr read_transform(const VdbHeader& header, const GridSummary& grid,
                                                  const SourceLocation& where) {
    if (header.is_nano) return read_nvdb_transform(header, grid, where);
    return GridStream(header, grid, grid, where).read_transform();
}

const GridSummary& holder_of_voxels(const VdbHeader& header, const GridSummary& grid) {
    if (grid.instance_of.empty()) return grid;
    for (const GridSummary& other : header.grids)
        if (other.unique_name == grid.instance_of && other.instance_of.empty() &&
            other.tree_type == grid.tree_type)
            return other;
    throw std::runtime_error("the grid it shares its voxels with is missing");
}

void read_slabs(const VdbHeader& header, const GridSummary& grid, std::size_t slab_bytes,
                const SourceLocation& where,
                const std::function<void(const openvdb::GridBase::Ptr&)>& take) {
    if (header.is_nano) {
        take(read_nvdb_grid(header, grid, where));
        return;
    }
    GridStream stream(header, grid, holder_of_voxels(header, grid), where);
    openvdb::GridBase::Ptr first = stream.read_topology();
    check_memory(*first, slab_bytes, describe_grid_place(header, grid, where));
    const std::vector<openvdb::CoordBBox> slabs = cut_into_slabs(*first, slab_bytes);
    if (slabs.empty()) {
        stream.read_values(*first);
        take(first);
        return;
    }
    first.reset();
    for (const openvdb::CoordBBox& slab : slabs) {
        throw_if_stopped();
        const openvdb::GridBase::Ptr part = stream.read_topology();
        stream.read_values(*part, slab);
        take(part);
    }
}

Affine to_affine(const openvdb::math::Transform& transform) {
    const auto column = [&](int axis) {
        openvdb::Vec3d unit(0, 0, 0);
        unit[axis] = 1;
        const openvdb::Vec3d v =
            transform.indexToWorld(unit) - transform.indexToWorld(openvdb::Vec3d(0, 0, 0));
        return Vector3(v.x(), v.y(), v.z());
    };
    const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0, 0, 0));
    return {Matrix3(column(0), column(1), column(2)), {origin.x(), origin.y(), origin.z()}};
}

std::string describe_grid_place(const VdbHeader& header, const GridSummary& grid,
                                const SourceLocation& where) {
    return fmt::format("{}: grid '{}' of '{}': ", where, grid.name, header.file.string());
}

}  // namespace uw
