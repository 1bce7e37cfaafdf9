#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/base/vector_math.h"
#include "core/geometry/water_surface.h"
#include "core/light/lamp_patch.h"
#include "core/light/lamp_profile.h"
#include "core/scene/scene_context.h"

namespace uw {

class SunFocus;

/// Parallel light that enters the water through its plane surface. There is none above.
struct Sunlight {
    Vector3 direction{0, -1, 0};  // of travel in the water, world, unit; downwards
    WaterSurfaceDesc surface;

    /// The light of a sun that travels in this direction (unit) in the air, refracted by Snell's
    /// law if the surface has an index; otherwise directions are given in the water.
    static Sunlight from_air(const Vector3& direction, const WaterSurfaceDesc& surface);

    /// The length of its path through the water to `x` [m]; negative above the surface.
    double length_to(const Point3& x) const {
        return glm::dot(surface.normal, x - surface.point) / per_metre();
    }
    /// How much that length grows per metre along a unit vector.
    double slope(const Vector3& v) const { return glm::dot(surface.normal, v) / per_metre(); }
    /// The point at which the light that reaches `x` enters the water.
    Point3 entry(const Point3& x) const { return x - length_to(x) * direction; }

    friend bool operator==(const Sunlight&, const Sunlight&) = default;

  private:
    double per_metre() const { return glm::dot(surface.normal, direction); }  // < 0
};

/// Radius of the sphere that represents a lamp: no in-scatter is gathered inside, where the 1/r^2
/// of a point source would grow without bound [m].
inline constexpr double k_lamp_radius = 1e-3;

/// The amount by which the squared distance of a point from a ray is increased where its light is
/// scattered on that ray [m^2], as if the point were offset in a fourth dimension. `patch_radius`:
/// of the disk with the area of the luminous surface that the point represents [m].
///
/// The light that a point scatters on a ray at the distance D grows as 1/D, so that each point of a
/// lamp with an extent would be visible as a bright dot. Within 3 patch radii r the squared
/// distance is D^2 + 0.36 r^2 (1 - 2.1983 D^2/r^2) (1 - D^2/(9 r^2))^2, which preserves the
/// integral of 1/D over parallel rays.
double squared_offset(const Point3& point, double patch_radius, const Ray& ray);

/// A point-like source of light in the world: radiant intensity I(w, lambda) = intensity *
/// profile(w) [W/sr]. A lamp of the scene, or one of the points that a lamp with an extent consists
/// of (core/light/lamp_factory.h). Or a sun, which has no place: its light is parallel and begins
/// at the water's surface, with an irradiance in place of an intensity [W/m^2]. In both cases the
/// light that reaches x comes in a straight line from origin(x), R away, and its irradiance on a
/// plane perpendicular to it would be intensity * relative_intensity(x - origin(x)) / spread(R)
/// without water.
class Lamp {
  public:
    /// `axis_intensity`: radiant intensity per band where the profile is 1 [W/sr].
    Lamp(std::string name, const Point3& position, LampProfile profile,
         const Spectrum& axis_intensity);
    /// A sun with this `irradiance` on a plane perpendicular to its light, at the water's surface,
    /// per band [W/m^2].
    Lamp(std::string name, const Sunlight& sunlight, const Spectrum& irradiance);

    /// A point of this lamp, which has this `index` in the scene: at `position`, with a `fraction`
    /// of its light. `patch`: the part of the luminous surface that the point represents; none: it
    /// is a lamp by itself.
    Lamp emitter(std::size_t index, const Point3& position, double fraction,
                 const std::optional<LampPatch>& patch = {}) const;

    /// A direction of this sun, which has this `index` in the scene, with a `fraction` of its
    /// light. `patch`: the part of the sun's disc that it represents; none: it has no disc.
    Lamp emitter(std::size_t index, const Vector3& direction, double fraction,
                 const std::optional<LampPatch>& patch = {}) const;

    /// A direction of this sun that represents a part of the sky and has its own irradiance on a
    /// plane perpendicular to it below the surface [W/m^2], which is the `fraction` of all light.
    /// `patch`: that part, as if of a sun's disc.
    Lamp emitter(std::size_t index, const Vector3& direction, const Spectrum& irradiance,
                 double fraction, const LampPatch& patch) const;

    /// A point of this lamp, an emissive volume, with its own intensity [W/sr], which is the
    /// `fraction` of all light. `patch`: the part of the volume that it represents.
    Lamp emitter(std::size_t index, const Point3& position, const Spectrum& intensity,
                 double fraction, const LampPatch& patch) const;

    /// The mirror image of this emitter, a point below a reflecting water surface: light that
    /// reaches a point after its reflection at the surface comes straight from the image, with the
    /// intensity that the image has in that direction (reflectance included).
    Lamp mirrored(const WaterSurface& surface) const;

    /// The same emitter, but `factor` times as bright.
    Lamp brightened(double factor) const;

    const std::string& name() const { return name_; }
    /// Which of the scene's lamps it belongs to; 0 unless it is an emitter.
    std::size_t index() const { return index_; }
    /// The fraction of that lamp's light that this emitter represents.
    double fraction() const { return fraction_; }
    /// The same sun, focused by waves: its light has their mean direction, and the same irradiance
    /// on a level plane.
    Lamp focused(std::shared_ptr<const SunFocus> focus) const;
    bool is_focused() const { return focus_ != nullptr; }
    /// The factor by which waves focus its light at `x` (SunFocus); 1 if they do not.
    double focus(const Point3& x) const;
    /// Multiplies each of `values` by that factor at its distance `s` along a ray.
    void focus(const Ray& ray, std::span<const double> s, std::span<double> values) const;

    /// Whether it is a mirror image, above the surface.
    bool is_mirrored() const { return mirror_.has_value(); }
    /// Its parallel light; null unless it is a sun.
    const Sunlight* sunlight() const { return sunlight_ ? &*sunlight_ : nullptr; }
    /// Its position; undefined for a sun.
    const Point3& position() const { return position_; }
    /// The origin of the light that reaches `x`: the position; for a sun, the point of the water's
    /// surface through which it enters (a point below `x` if `x` lies above the surface).
    Point3 origin(const Point3& x) const { return sunlight_ ? sunlight_->entry(x) : position_; }
    /// Whether it is one of several that represent parts of a luminous surface or of a sun's disc:
    /// its shadows are soft (origin_on_patch). A lamp that consists of one point casts hard ones.
    bool is_part() const { return patch_ && fraction_ < 1; }
    /// The origin of the light that reaches `x` from the point of the patch to which `place` in the
    /// unit cube maps. Precondition: is_part().
    Point3 origin_on_patch(const Point3& x, const UnitPoint& place) const;
    /// The angle that the radius of its patch subtends at this distance, to first order; 0 without
    /// a patch.
    double patch_angle(double distance) const {
        return patch_ ? patch_->radius / std::sqrt(spread(distance)) : 0;
    }
    /// The divisor of its light at a distance R from its origin: R^2; 1 for a sun.
    double spread(double distance) const { return sunlight_ ? 1 : distance * distance; }
    /// uw::squared_offset for a point of a lamp with an extent [m^2]; 0 for all others.
    double squared_offset(const Ray& ray) const {
        return patch_ && !sunlight_ ? uw::squared_offset(position_, patch_->radius, ray) : 0;
    }
    /// Whether a point at this distance from its origin lies in the sphere that represents it.
    bool contains(double distance) const { return !sunlight_ && distance < k_lamp_radius; }
    /// Radiant intensity on the axis per band [W/sr]; for an IES profile, in the brightest
    /// direction; for a sun, irradiance [W/m^2].
    const Spectrum& axis_intensity() const { return axis_intensity_; }
    /// The name of its profile in reports: "spot".
    std::string_view profile_name() const;

    /// Intensity in the direction of `v` (from the origin; of the length of the way there if this
    /// is_part(), as the edge of its beam is the softer the nearer it is, else of any length),
    /// relative to axis_intensity: 0..1. For a sun, 0 above the water, where `v` points against its
    /// light.
    double relative_intensity(const Vector3& v) const;
    /// Whether a relative intensity of 1 at a point implies 1 everywhere around it, up to the next
    /// break of the profile (append_profile_breaks): the core of a spot.
    bool has_even_core() const;
    /// Whether the profile may end between two of its breaks, as that of a part of a spot does
    /// (SoftSpotProfile).
    bool is_soft() const;

    /// A cone outside which the lamp emits no light.
    DirectionCone cone() const;

    /// The part of the interval `interval` of `ray` outside which the lamp emits no light; of
    /// length 0 where it misses the beam. It may still contain dark parts.
    Interval beam(const Ray& ray, const Interval& interval) const;

    /// Appends distances along `ray` between which, within `interval`, the profile is smooth and
    /// changes little (IsALampProfile); for a sun, the water's surface.
    void append_profile_breaks(const Ray& ray, const Interval& interval,
                               std::vector<double>& s) const;

    /// Compares all members.
    friend bool operator==(const Lamp&, const Lamp&) = default;

  private:
    void append_focus_breaks(const Ray& ray, const Interval& interval,
                             std::vector<double>& s) const;
    Interval below_surface(const Ray& ray, const Interval& interval) const;

    std::string name_;
    Point3 position_;
    LampProfile profile_;
    Spectrum axis_intensity_{};
    std::optional<Sunlight> sunlight_;
    std::shared_ptr<const SunFocus> focus_;  // null: none
    std::optional<WaterSurface> mirror_;     // of an image, whose profile_ is that of the original
    std::size_t index_ = 0;
    double fraction_ = 1;
    std::optional<LampPatch> patch_;
};

}  // namespace uw
