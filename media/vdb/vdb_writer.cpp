#include "media/vdb/vdb_writer.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <memory>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "media/vdb/openvdb_grids.h"
#include "media/vdb/vdb_header_reader.h"

namespace uw {
namespace {

/// One block of 8^3 values, or nothing if all are 0 or outside the grid.
std::unique_ptr<openvdb::FloatTree::LeafNodeType> make_block(const VdbOutputGrid& grid,
                                                             const openvdb::Coord& origin) {
    auto leaf = std::make_unique<openvdb::FloatTree::LeafNodeType>(origin, 0.0F);
    const auto end = [&](int axis) {
        return std::min(origin[axis] + k_leaf_edge, grid.size[static_cast<std::size_t>(axis)]);
    };
    for (int i = origin[0]; i < end(0); ++i)
        for (int j = origin[1]; j < end(1); ++j)
            for (int k = origin[2]; k < end(2); ++k) {
                const float value = grid.value(i, j, k);
                if (value != 0) leaf->setValueOn(openvdb::Coord(i, j, k), value);
            }
    if (leaf->isEmpty()) leaf.reset();
    return leaf;
}

openvdb::FloatGrid::Ptr make_grid(const VdbOutputGrid& source) {
    auto grid = make_empty_grid<openvdb::FloatGrid>(0.0F);
    grid->setName(source.name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    const auto transform = openvdb::math::Transform::createLinearTransform(source.voxel_size);
    transform->postTranslate(openvdb::Vec3d(source.origin.x, source.origin.y, source.origin.z));
    grid->setTransform(transform);
    for (const auto& [key, value] : source.metadata)
        grid->insertMeta(key, openvdb::StringMetadata(value));
    for (int i = 0; i < source.size[0]; i += k_leaf_edge)
        for (int j = 0; j < source.size[1]; j += k_leaf_edge)
            for (int k = 0; k < source.size[2]; k += k_leaf_edge)
                if (auto leaf = make_block(source, {i, j, k}))
                    grid->tree().addLeaf(leaf.release());  // the tree owns it
    return grid;
}

}  // namespace

void write_vdb(const std::filesystem::path& file, const std::vector<VdbOutputGrid>& grids,
               const std::vector<std::pair<std::string, std::string>>& metadata) {
    initialize_openvdb();
    AtomicFile target(file);
    try {
        openvdb::GridPtrVec output;
        for (const VdbOutputGrid& grid : grids) output.push_back(make_grid(grid));
        openvdb::MetaMap map;
        for (const auto& [key, value] : metadata)
            map.insertMeta(key, openvdb::StringMetadata(value));
        openvdb::io::File(target.temporary_path().string()).write(output, map);
        // OpenVDB does not notice a full disk; reading the header back does.
        read_vdb_header(target.temporary_path(), "written file");
    } catch (const std::bad_alloc&) {
        throw IoError(fmt::format("{}: cannot write: not enough memory", file.string()));
    } catch (const std::exception& error) {
        throw IoError(
            fmt::format("{}: cannot write: {}; is the disk full?", file.string(), error.what()));
    }
    target.commit();
}

}  // namespace uw
