#pragma once

#include <openvdb/openvdb.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <istream>
#include <new>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/vector_math.h"
#include "media/volumes/grid_bricks.h"
#include "media/volumes/vdb_header.h"

namespace uw {

/// Traverses the tree of a grid of floats, doubles, integers or 3-vectors of them in the file
/// without decoding it, and checks that each block of values has the size implied by its masks.
/// OpenVDB 10 trusts the block sizes and would write past its buffers. `tree_offset`: where the
/// tree begins, after the transform. Throws InputError starting with `where`.
void check_layout(const VdbHeader& header, const GridSummary& grid, std::int64_t tree_offset,
                  const SourceLocation& where);

/// Checks what OpenVDB 10 believes of a frustum transform: the length of its second map's name, for
/// which it makes room, and that this is no frustum again, which it reads by recursion. Throws
/// InputError starting with `where`.
void check_transform(const VdbHeader& header, const GridSummary& grid, const SourceLocation& where);

/// Grids of a VDB file as OpenVDB objects, for the files that access voxels.

/// A file whose reading ends with Interrupted once the calling thread's work is to stop.
class StoppableFile : public std::filebuf {
  protected:
    std::streamsize xsgetn(char* bytes, std::streamsize count) override {
        throw_if_stopped();
        return std::filebuf::xsgetn(bytes, count);
    }
};

/// One grid's part of the file, as a stream set up as openvdb::io::File does it. File itself would
/// reject the whole file for one grid of an unknown type, and clips in world space.
class GridStream {
  public:
    /// `voxels`: the grid that holds the voxels of `grid`, usually itself (holder_of_voxels).
    GridStream(const VdbHeader& header, const GridSummary& grid, const GridSummary& voxels,
               const SourceLocation& where);

    openvdb::math::Transform::ConstPtr read_transform();
    /// A grid with its transform and tree, but no voxel values yet.
    openvdb::GridBase::Ptr read_topology();
    void read_values(openvdb::GridBase& grid);
    /// Only the voxels within `box`; the others become inactive.
    void read_values(openvdb::GridBase& grid, const openvdb::CoordBBox& box);

  private:
    void check_layout_once();

    const VdbHeader& header_;
    const GridSummary& grid_;
    const GridSummary& voxels_;
    const SourceLocation& where_;
    bool layout_checked_ = false;
    StoppableFile file_;
    std::istream stream_{&file_};
    // The stream keeps a pointer to this member.
    openvdb::io::StreamMetadata::Ptr metadata_{new openvdb::io::StreamMetadata};
};

/// The transform of a grid of either format.
openvdb::math::Transform::ConstPtr read_transform(const VdbHeader& header, const GridSummary& grid,
                                                  const SourceLocation& where);

/// The grid whose voxels `grid` shares, or itself. Throws std::runtime_error if it is missing.
const GridSummary& holder_of_voxels(const VdbHeader& header, const GridSummary& grid);

/// A linear transform as an affine map.
Affine to_affine(const openvdb::math::Transform& transform);

/// Reads a grid in slabs of about `slab_bytes` and passes each to `take`; their active voxels are
/// disjoint. The grid is split along its longest axis at block boundaries, so that no slab holds
/// more than `slab_bytes` of leaf values, or an eighth of all. A NanoVDB grid comes as a single
/// slab. The value type is one of ReadableGrids. Throws InputError starting with `where`, also if a
/// slab and what is made of all of them do not fit into free memory; Interrupted; and OpenVDB's
/// exceptions.
void read_slabs(const VdbHeader& header, const GridSummary& grid, std::size_t slab_bytes,
                const SourceLocation& where,
                const std::function<void(const openvdb::GridBase::Ptr&)>& take);

/// The result of `read`; OpenVDB's exceptions become an InputError that starts with `prefix`, and
/// Interrupted passes.
template <class Read>
auto read_guarded(const std::string& prefix, const Read& read) {
    try {
        return read();
    } catch (const InputError&) {
        throw;
    } catch (const Interrupted&) {
        throw;
    } catch (const std::ios_base::failure&) {
        throw InputError(prefix + "the file is truncated or damaged; copy or export it again");
    } catch (const std::bad_alloc&) {
        throw InputError(prefix + "it needs more memory than is available");
    } catch (const std::exception& error) {
        constexpr std::size_t k_longest = 200;  // it may quote the file
        throw InputError(prefix + "cannot be read: " + printable(error.what(), k_longest));
    }
}

/// "where: grid 'name' of 'file': ", the beginning of messages.
std::string describe_grid_place(const VdbHeader& header, const GridSummary& grid,
                                const SourceLocation& where);

}  // namespace uw
