#pragma once

#include <memory>

#include "core/base/vector_math.h"
#include "core/scene/volume_desc.h"

namespace uw {

class VelocityField;

/// The velocity of a volume's water in the world. Thread safe.
class VolumeVelocity {
  public:
    /// Reads the grids of `desc.motion`, which it has, and places them as the volume. Throws
    /// InputError (VelocityField) and IoError.
    explicit VolumeVelocity(const VolumeDesc& desc);
    ~VolumeVelocity();
    VolumeVelocity(VolumeVelocity&& other) noexcept;
    VolumeVelocity& operator=(VolumeVelocity&& other) noexcept;
    VolumeVelocity(const VolumeVelocity&) = delete;
    VolumeVelocity& operator=(const VolumeVelocity&) = delete;

    /// The velocity at `x` (world) [m/s]; zero outside the grids.
    Vector3 at(const Point3& x) const;

  private:
    std::unique_ptr<const VelocityField> field_;
    Affine world_from_file_, file_from_world_;
};

}  // namespace uw
