#pragma once

#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/base/vector_math.h"
#include "core/geometry/water_surface.h"

namespace uw {

/// How waves focus the light of a sun in the water below them: caustics. A factor on its plane
/// irradiance below calm water, whose mean over a level plane is the share that waves let through,
/// relative to that of calm water.
///
/// A regular grid of beams meets the waves, nine for each texel, and is refracted by them. Where
/// each crosses a level plane its flux is shared out among the nine texels around, and so at a
/// series of depths, which lie closer near the surface. Between depths the factor is linear along
/// light's mean direction. What beams differ from it, by a few degrees, moves light to where it
/// goes, but counts neither for scattering angles nor for lengths.
class SunFocus {
  public:
    /// What of the water the map holds.
    struct Extent {
        double side = 0;           ///< of a level square [m], > 0
        bool is_periodic = false;  ///< the square repeats; else there is no focusing outside
        double u = 0, v = 0;       ///< its centre, in the surface's coordinates
        double depth = 0;          ///< down to here [m], > 0; the same below

        friend bool operator==(const Extent&, const Extent&) = default;
    };

    /// `direction` of the sun's light in the air, unit; `angle` across its disc in the air [rad].
    /// Precondition: the surface has waves.
    SunFocus(const WaterSurface& surface, const Vector3& direction, double angle,
             const Extent& extent, int resolution);

    /// In which light travels in the water in the mean, world, unit: flatter than below calm water
    /// where the sun is low, since slopes that face it catch more and turn it less. By the waves'
    /// statistics: the same at any time.
    const Vector3& direction() const { return direction_; }
    /// The factor at a point in the world, >= 0; 1 above the water.
    double at(const Point3& x) const;
    /// Multiplies each of `values` by the factor at its distance `s` [m] along a ray.
    void apply(const Ray& ray, std::span<const double> s, std::span<double> values) const;
    /// Side of a texel [m].
    double texel() const { return extent_.side / resolution_; }
    /// By how many metres the place in the map changes per metre along a unit vector, level.
    double slide(const Vector3& direction) const;

  private:
    /// Where light of the beams' direction enters [texels, from the surface's origin], and how far
    /// below [m].
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
