#pragma once

#include "core/base/affine.h"
#include "core/scene/volume_desc.h"

namespace uw {

/// A grid's transform as `desc` has it: that of the file, scaled about its origin such that its
/// voxels have edges of VolumeDesc::voxel_size, if the scene gives one. Throws InputError if these
/// are no cubes.
Affine with_voxel_size(const Affine& file_from_index, const VolumeDesc& desc);

}  // namespace uw
