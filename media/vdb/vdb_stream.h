#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <map>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "core/base/affine.h"
#include "core/base/error.h"
#include "media/vdb/vdb_header.h"

/// Grids of a VDB file as OpenVDB has them, for the files that look at voxels.
namespace uw {

/// To be called before anything is read.
void initialize_openvdb();

/// One grid's part of the file, as a stream set up the way openvdb::io::File does it. File itself
/// would refuse the whole file for one grid of a type it does not know, and clips in world space.
class GridStream {
  public:
    /// `voxels`: the grid that holds the voxels of `grid`, mostly itself (holder_of_voxels).
    GridStream(const VdbHeader& header, const GridSummary& grid, const GridSummary& voxels,
               const SourceLocation& where);

    openvdb::math::Transform::ConstPtr read_transform();
    /// A grid with its transform and tree, but no voxel values yet.
    template <class GridT>
    typename GridT::Ptr read_topology() {
        auto grid = GridT::create();
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
    template <class GridT>
    void read_values(GridT& grid) {
        grid.readBuffers(stream_);
    }
    /// Only the voxels within `box`; the others become inactive.
    template <class GridT>
    void read_values(GridT& grid, const openvdb::CoordBBox& box) {
        grid.readBuffers(stream_, box);
    }

  private:
    void check_layout_once();

    const VdbHeader& header_;
    const GridSummary& grid_;
    const GridSummary& voxels_;
    const SourceLocation& where_;
    bool layout_checked_ = false;
    std::ifstream stream_;
    // The stream keeps a pointer to this very member.
    openvdb::io::StreamMetadata::Ptr metadata_{new openvdb::io::StreamMetadata};
};

/// The transform of a grid of either format.
openvdb::math::Transform::ConstPtr read_transform(const VdbHeader& header, const GridSummary& grid,
                                                  const SourceLocation& where);

/// A grid of a NanoVDB file, checked and unpacked: its active values. GridT is the type that
/// `grid.value_type` names. Throws InputError starting with `where` for damage.
template <class GridT>
typename GridT::Ptr read_nvdb_grid(const VdbHeader& header, const GridSummary& grid,
                                   const SourceLocation& where);
openvdb::math::Transform::Ptr read_nvdb_transform(const VdbHeader& header, const GridSummary& grid,
                                                  const SourceLocation& where);

/// The grid whose voxels `grid` shares, or itself. Throws std::runtime_error if it is missing.
const GridSummary& holder_of_voxels(const VdbHeader& header, const GridSummary& grid);

/// The affine map that a linear transform is.
Affine to_affine(const openvdb::math::Transform& transform);

/// Cuts a tree (topology only) across its longest axis at block boundaries, so that no slab holds
/// more than `slab_bytes` of leaf values, or an eighth of all. Empty: no need to cut.
template <class TreeT>
std::vector<openvdb::CoordBBox> cut_into_slabs(const TreeT& tree, std::size_t slab_bytes) {
    openvdb::CoordBBox box;
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) box.expand(leaf->origin());
    const std::size_t leaf_bytes =
        sizeof(typename TreeT::ValueType) * std::size_t{TreeT::LeafNodeType::SIZE};
    const std::size_t total = tree.leafCount() * leaf_bytes;
    if (total <= slab_bytes) return {};
    slab_bytes = std::max(slab_bytes, total / 8);

    const std::size_t axis = box.maxExtent();
    std::map<int, std::size_t> leaves_at;
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) ++leaves_at[leaf->origin()[axis]];
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

/// Reads a grid in slabs of about `slab_bytes` and hands each to `take(GridT::Ptr)`; their active
/// voxels are disjoint. Of a NanoVDB file all comes at once. Throws InputError starting with
/// `where`, and what OpenVDB throws.
template <class GridT, class Take>
void read_slabs(const VdbHeader& header, const GridSummary& grid, std::size_t slab_bytes,
                const SourceLocation& where, const Take& take) {
    if (header.is_nano) {
        take(read_nvdb_grid<GridT>(header, grid, where));
        return;
    }
    GridStream stream(header, grid, holder_of_voxels(header, grid), where);
    typename GridT::Ptr first = stream.template read_topology<GridT>();
    const std::vector<openvdb::CoordBBox> slabs = cut_into_slabs(first->tree(), slab_bytes);
    if (slabs.empty()) {
        stream.read_values(*first);
        take(std::move(first));
        return;
    }
    first.reset();
    for (const openvdb::CoordBBox& slab : slabs) {
        typename GridT::Ptr part = stream.template read_topology<GridT>();
        stream.read_values(*part, slab);
        take(std::move(part));
    }
}

/// What `read` returns; what OpenVDB throws becomes an InputError that starts with `prefix`.
template <class Read>
auto read_guarded(const std::string& prefix, const Read& read) {
    try {
        return read();
    } catch (const InputError&) {
        throw;
    } catch (const std::ios_base::failure&) {
        throw InputError(prefix + "the file is cut short or damaged; copy or export it again");
    } catch (const std::bad_alloc&) {
        throw InputError(prefix + "it needs more memory than there is");
    } catch (const std::exception& error) {
        throw InputError(prefix + "cannot be read: " + error.what());
    }
}

/// "where: grid 'name' of 'file': ", the beginning of messages.
std::string describe_grid_place(const VdbHeader& header, const GridSummary& grid,
                                const SourceLocation& where);

}  // namespace uw
