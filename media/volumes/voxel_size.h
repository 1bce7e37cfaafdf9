#pragma once

#include <optional>

#include "core/base/affine.h"
#include "core/scene/volume_desc.h"
#include "media/volumes/adaptive_domain.h"

namespace uw {

/// A grid's transform, set right: scaled about the file's origin such that its voxels have edges of
/// VolumeDesc::voxel_size if the scene gives one, else of what is known of an adaptive `domain`, in
/// which it is moved to its place. Throws InputError if the voxels are to be scaled and are no
/// cubes.
Affine with_voxel_size(const Affine& file_from_index, const VolumeDesc& desc,
                       const std::optional<AdaptiveDomain>& domain);

}  // namespace uw
