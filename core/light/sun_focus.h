#pragma once

#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/base/vector_math.h"
#include "core/geometry/water_surface.h"

namespace uw {

/// Caustics: how waves focus the light of a sun in the water below them, as a factor on its plane
/// irradiance below calm water. Its mean over a level plane is the transmittance of the waves
/// relative to that of calm water.
///
/// The waves refract a regular grid of beams, nine for each texel. Where a beam crosses a level
/// plane, its flux is splatted onto the nine texels around; this is done at a series of depths,
/// which lie closer together near the surface. Between depths the factor is linear along the
/// light's mean direction. The deviation of beams from that direction, by a few degrees, determines
/// where their light arrives, but is ignored for scattering angles and path lengths.
class SunFocus {
  public:
    /// The part of the water that the map covers.
    struct Extent {
        double side = 0;           ///< of a level square [m], > 0
        bool is_periodic = false;  ///< the square repeats; else there is no focusing outside
        double u = 0, v = 0;       ///< its centre, in the surface's coordinates
        double depth = 0;          ///< down to which the factor varies [m], > 0; constant below

        friend bool operator==(const Extent&, const Extent&) = default;
    };

    /// `direction` of the sun's light in the air, unit; `angle` across its disc in the air [rad].
    /// Precondition: the surface has waves.
    SunFocus(const WaterSurface& surface, const Vector3& direction, double angle,
             const Extent& extent, int resolution);

    /// The mean direction of travel of the light in the water, world, unit: flatter than below calm
    /// water if the sun is low, since slopes that face it receive more light and refract it less.
    /// It follows from the waves' statistics and is the same at any time.
    const Vector3& direction() const { return direction_; }
    /// The factor at a point in the world, >= 0; 1 above the water.
    double at(const Point3& x) const;
    /// Multiplies each of `values` by the factor at its distance `s` [m] along a ray.
    void apply(const Ray& ray, std::span<const double> s, std::span<double> values) const;
    /// Side of a texel [m].
    double texel() const { return extent_.side / resolution_; }
    /// How far a point moves across the map [m] per metre along a unit vector.
    double slide(const Vector3& direction) const;

  private:
    /// A point of the map: where light with the mean direction enters the water [texels, from the
    /// surface's origin], and the depth below it [m].
    struct Place {
        double u = 0, v = 0, depth = 0;
    };
    /// `at` is given in the surface's coordinates; the result is linear in them.
    Place place(const Vector3& at) const;
    double factor(const Place& place) const;
    double depth_of(std::size_t slice) const;
    void blur(Grid2D<float>& slice, double radius) const;

    WaterSurface surface_;
    Extent extent_;
    int resolution_;
    Vector3 direction_{};
    double shift_u_ = 0, shift_v_ = 0;  // of light with this direction per metre of depth
    double first_u_ = 0, first_v_ = 0;  // of the first texel's centre, as in Place
    std::vector<Grid2D<float>> slices_;
};

}  // namespace uw
