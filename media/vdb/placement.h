#pragma once

#include "core/base/affine.h"
#include "core/scene/volume_desc.h"
#include "media/vdb/loaded_grid.h"

namespace uw {

/// How a file's grids are placed, with `automatic` resolved.
struct Placement {
    Centering centering = Centering::node;  // cell: value (i, j, k) sits at index i + 1/2; node: i
    UpAxis up = UpAxis::y;                  // z: the file's (x, y, z) is the scene's (x, z, -y)
    bool automatic_centering = false, automatic_up = false;  // decided from the file, not the scene
};

/// Automatic means cell and z for caches of Blender's fluid solver, node and z for what EmberGen
/// exports, node and y for all others.
Placement decide_placement(const VdbHeader& header, const VolumeDesc& desc);

/// Rotates the file's up axis to y.
Affine upright_from_file(UpAxis up);

/// World from the file's index space: transform * up * the file's own transform.
Affine world_from_index(const LoadedGrid& grid, const Placement& placement,
                        const Affine& world_from_upright);

}  // namespace uw
