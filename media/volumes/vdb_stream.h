#pragma once

#include <openvdb/openvdb.h>

#include <cstddef>
#include <functional>
#include <ios>
#include <new>
#include <string>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/vector_math.h"
#include "media/volumes/vdb_header.h"

namespace uw {

/// The voxels of one grid of a VDB or NanoVDB file as OpenVDB objects, for the files that access
/// them.

/// The transform of a grid of either format.
openvdb::math::Transform::ConstPtr read_transform(const VdbHeader& header, const GridSummary& grid,
                                                  const SourceLocation& where);

/// A linear transform as an affine map.
Affine to_affine(const openvdb::math::Transform& transform);

/// Reads a grid in slabs of about `slab_bytes` and passes each to `take`; their active voxels are
/// disjoint. The grid is split along its longest axis at block boundaries, so that no slab contains
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
    } catch (const OutOfMemory&) {
        throw;
    } catch (const std::ios_base::failure&) {
        throw InputError(prefix + "the file is truncated or damaged; copy or export it again");
    } catch (const std::bad_alloc&) {
        throw OutOfMemory(prefix +
                          "it needs more memory than is free; resample it to larger voxels");
    } catch (const std::exception& error) {
        constexpr std::size_t k_longest = 200;  // it may quote the file
        throw InputError(prefix + "cannot be read: " + printable(error.what(), k_longest));
    }
}

/// "where: grid 'name' of 'file': ", the beginning of messages.
std::string describe_grid_place(const VdbHeader& header, const GridSummary& grid,
                                const SourceLocation& where);

}  // namespace uw
