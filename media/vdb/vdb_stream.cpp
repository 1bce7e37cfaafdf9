#include "media/vdb/vdb_stream.h"

#include <fmt/format.h>

#include <stdexcept>

#include "media/vdb/vdb_layout.h"

namespace uw {

void initialize_openvdb() {
    static const bool done = (openvdb::initialize(), true);
    static_cast<void>(done);
}

GridStream::GridStream(const VdbHeader& header, const GridSummary& grid, const GridSummary& voxels,
                       const SourceLocation& where)
    : header_(header),
      grid_(grid),
      voxels_(voxels),
      where_(where),
      stream_(header.file, std::ios::binary) {
    stream_.exceptions(std::ios::failbit | std::ios::badbit);
    metadata_->setFileVersion(header.version);
    metadata_->setLibraryVersion({header.library_major, header.library_minor});
    metadata_->setCompression(voxels.compression);
    metadata_->setHalfFloat(voxels.half);
    metadata_->setSeekable(true);
    openvdb::io::setStreamMetadataPtr(stream_, metadata_, /*transfer=*/true);
}

openvdb::math::Transform::ConstPtr GridStream::read_transform() {
    openvdb::FloatGrid grid;
    stream_.seekg(grid_.transform_offset);
    grid.readTransform(stream_);
    return grid.transformPtr();
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
