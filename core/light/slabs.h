#pragma once

#include "core/base/ray.h"
#include "core/base/vector_math.h"
#include "core/light/integrator.h"
#include "core/scene/render_desc.h"

namespace uw {

/// Adjacent slabs of water of equal thickness, parallel to the image plane and stacked along camera
/// z [m].
struct Slabs {
    double near = 0;  // camera z where the first slab begins
    double far = 0;   // and where the last one ends; > near
    int count = 1;

    double thickness() const { return (far - near) / count; }
    /// Camera z of the boundary between slab `i` - 1 and slab `i`, 0 <= i <= count.
    double boundary(int i) const { return near + (far - near) * i / count; }
};

/// Camera z along one ray in world space, or the distance from the ray's origin.
class RayDepth {
  public:
    /// Uses the distance from the ray's origin instead of camera z.
    static RayDepth from_origin() { return {0, 1}; }
    RayDepth(const Affine& camera_from_world, const Ray& ray)
        : origin_((camera_from_world * ray.origin).z),
          cosine_(camera_from_world.apply_to_vector(ray.direction).z) {}

    /// Cosine of the ray's angle to the optical axis; a ray that does not point forward (<= 0)
    /// crosses no slabs.
    double cosine() const { return cosine_; }
    double z(double s) const { return origin_ + cosine_ * s; }
    /// Distance along the ray to camera z = `z` [m], negative before its origin. Precondition:
    /// cosine() > 0.
    double distance(double z) const { return (z - origin_) / cosine_; }

  private:
    RayDepth(double origin, double cosine) : origin_(origin), cosine_(cosine) {}

    double origin_;
    double cosine_;
};

/// The slabs that `desc` specifies. If omitted, `near` defaults to where the water begins (the
/// least camera z of the image's water rays, never below 0) and `far` to the greatest camera z of
/// the surfaces hit by a coarse lattice of rays or, where rays hit no surface, to the depth beyond
/// which less than 1e-4 of a lamp's in-scatter lies. If `far` is omitted, slabs of the same
/// thickness also continue behind it to that depth, so that no water is lost; `count` of the result
/// includes them. Throws InputError if no water lies between near and far.
Slabs place_slabs(const PlanesDesc& desc, const RaySource& rays, const LitScene& scene);

}  // namespace uw
