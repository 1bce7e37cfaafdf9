#pragma once

#include <optional>

#include "camera/port/port.h"
#include "core/base/ray_source.h"

namespace uw {

/// A thin lens with its aperture at the camera's centre, focused at a plane across the optical axis
/// (docs/camera-image.md). In the housing's air all rays of an image position pass through one
/// point of a plane; through a port they meet where the water's refraction lets them.
class ThinLens {
  public:
    /// Precondition: the camera has a lens with a focus distance. Throws InputError if that lies
    /// before the water, and if the aperture does not fit into the dome.
    ThinLens(const CameraDesc& desc, const std::optional<Port>& port);

    /// The ray in the housing (camera frame) that leaves a point of the aperture, for the image
    /// position whose ray through the aperture's centre has `direction`, direction.z > 0.
    Ray ray(const Vector3& direction, const AperturePoint& point) const;

    /// 1 / distance of the plane in air where the rays of an image position meet [1/m]. Behind a
    /// port it is such that rays near the axis meet at the focus distance in the water.
    double vergence() const { return vergence_; }

  private:
    double radius_;  // of the aperture: focal length / (2 f-number) [m]
    double vergence_ = 0;
};

}  // namespace uw
