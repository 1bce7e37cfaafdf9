#pragma once

#include <vector>

#include "core/base/ray.h"
#include "render/snow/exposure_views.h"

namespace uw {

/// A convex body around all that an image sees up to a distance while its shutter is open, through
/// all of the lens's aperture: of what drifts, where it is in the middle of the exposure.
class ViewHull {
  public:
    /// `reach` [m] along rays in water; `drift` [m/s].
    ViewHull(const std::vector<ExposureView>& views, double reach, const Vector3& drift);

    /// Whether a sphere may be seen; false only if it is not.
    bool may_see(const Point3& centre, double radius) const {
        for (const Plane& plane : planes_)
            if (glm::dot(plane.normal, from_origin(centre)) > plane.offset + radius) return false;
        return true;
    }
    /// Around all that is seen; empty if nothing is.
    const Bounds& bounds() const { return bounds_; }

  private:
    struct Plane {
        Vector3 normal;  // out of the body
        double offset;
    };
    std::vector<Plane> planes_;
    Bounds bounds_;
};

}  // namespace uw
