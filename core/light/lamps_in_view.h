#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/light/integrator.h"
#include "core/light/lamp.h"
#include "core/light/medium.h"
#include "core/scene/lamp_desc.h"

namespace uw {

/// Points that stand for a luminous surface, each for as much of it.
struct LampPoints {
    std::vector<Point3> positions;
    double patch_radius = 0;  // distance_aside
};

/// The luminous surface of a lamp with an extent, in the world.
struct LampSurface {
    Lamp lamp;  // all of it, at its centre
    LampExtentDesc extent;
    Vector3 x, y;         // unit vectors in the surface: x along a rectangle's width
    LampPoints emitters;  // as in LitScene::emitters
    LampPoints many;      // so many that they are as good as the surface

    /// The light that the surface scatters on this stretch of a ray in proportion to that of its
    /// emitters, if all directions of scattering count alike: an integral of 1/R^2. 1 but for rays
    /// that pass the surface closely.
    double evenness(const Ray& ray, const Interval& stretch) const;

    double area() const;  // [m^2]
    /// Where `ray` crosses the surface [m]; infinite if it does not.
    double crossing(const Ray& ray) const;
    /// Its radiance towards the origin of a ray that crosses it, for 1 W/sr on the axis [1/m^2]:
    /// relative intensity over the area that is seen. 0 for a surface that is seen edge-on.
    double radiance_towards(const Ray& ray) const;
};

/// LampSurface::evenness of the scene's lamp with this index; 1 for a lamp without an extent.
double evenness(const LitScene& scene, std::size_t lamp, const Ray& ray, const Interval& stretch);

/// Finds the same for each stretch of a ray between `begin` and the ascending `distances`.
void find_evenness(const LitScene& scene, std::size_t lamp, const Ray& ray, double begin,
                   std::span<const double> distances, std::vector<double>& result);

/// A lamp whose luminous surface a ray crosses.
struct SeenLamp {
    std::size_t lamp = 0;  // its index in the scene
    double distance = 0;   // along the ray [m]
    Spectrum radiance;     // of the surface [W m^-2 sr^-1]
    Spectrum arriving;     // what of that arrives at the ray's origin, times its PathWeight
};

/// What the camera sees of lamps themselves. A luminous surface adds its light to what is behind
/// it: as it throws no shadow, it hides nothing. Thread safe.
class LampsInView {
  public:
    /// `scene` must outlive this object.
    LampsInView(const LitScene& scene, const PathWeight& weight)
        : scene_(scene), weight_(weight), attenuation_(*scene.medium) {}

    /// Appends the lamps that `ray` crosses up to the surface at `reach` [m]; one that lies on that
    /// surface is before it.
    void append(const Ray& ray, double reach, std::vector<SeenLamp>& seen) const;

  private:
    LitScene scene_;
    PathWeight weight_;
    AttenuationTable attenuation_;
};

}  // namespace uw
