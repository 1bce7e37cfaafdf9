#pragma once

#include <optional>
#include <vector>

#include "core/base/affine.h"
#include "core/scene/volume_desc.h"

namespace uw {

/// Checks, from the files' headers alone, whether the frames of a volume are consistent.
class VolumeSequenceCheck {
  public:
    /// Takes the next frame. Throws InputError with the file's name if a grid that the scene uses
    /// is missing or cannot be used (select_grid), or if its transform differs from that of the
    /// first frame: the same voxel would then lie elsewhere; IoError.
    void take(const VolumeDesc& frame);

  private:
    VolumeDesc first_;
    std::vector<Affine> transforms_;  // of the first frame's grids
};

}  // namespace uw
