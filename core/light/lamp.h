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
    Vector3 direction{0, -1, 0};  // in which it travels in the water, world, unit; downwards
    WaterSurfaceDesc surface;

    /// The light of a sun in this direction (unit) in the air: below a surface that refracts, as
    /// Snell has it; elsewhere directions are those in the water anyway.
    static Sunlight from_air(const Vector3& direction, const WaterSurfaceDesc& surface);

    /// How far it has come through the water at `x` [m]; negative above the surface.
    double length_to(const Point3& x) const {
        return glm::dot(surface.normal, x - surface.point) / per_metre();
    }
    /// How much that length grows per metre along a unit vector.
    double slope(const Vector3& v) const { return glm::dot(surface.normal, v) / per_metre(); }
    /// Where the light that reaches `x` enters the water.
    Point3 entry(const Point3& x) const { return x - length_to(x) * direction; }

    friend bool operator==(const Sunlight&, const Sunlight&) = default;

  private:
    double per_metre() const { return glm::dot(surface.normal, direction); }  // < 0
};

/// Radius of the sphere that represents a lamp: no in-scatter is gathered inside, where the 1/r^2
/// of a point source would grow without bound [m].
inline constexpr double k_lamp_radius = 1e-3;

/// By how much the square of a point's distance from a ray is increased where its light is
/// scattered on that ray [m^2], as if it lay aside in a fourth dimension. `patch_radius`: of the
/// disk whose area is that of the luminous surface that the point stands for [m].
///
/// What a point scatters on a ray at the distance D grows as 1/D, so that each point of a lamp with
/// an extent would be seen as a bright dot. Within 3 patch radii r the square of the distance is
/// D^2 + 0.36 r^2 (1 - 2.1983 D^2/r^2) (1 - D^2/(9 r^2))^2, by which the integral of 1/D over all
/// rays beside each other stays what it is.
double distance_aside(const Point3& point, double patch_radius, const Ray& ray);

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

    /// A point of this lamp, the scene's with this `index`: at `position`, with a `share` of its
    /// light. `patch`: the part of the luminous surface that the point stands for; none: it is a
    /// lamp by itself.
    Lamp emitter(std::size_t index, const Point3& position, double share,
                 const std::optional<LampPatch>& patch = {}) const;

    /// A direction of this sun, the scene's lamp with this `index`: with a `share` of its light.
    /// `patch`: the part of the sun's disc that it stands for; none: it has no disc.
    Lamp emitter(std::size_t index, const Vector3& direction, double share,
                 const std::optional<LampPatch>& patch = {}) const;

    /// A direction of this sun that stands for a part of the sky, with an irradiance of its own, on
    /// a plane perpendicular to it below the surface [W/m^2], the `share` of all light. `patch`:
    /// that part, as of a sun's disc.
    Lamp emitter(std::size_t index, const Vector3& direction, const Spectrum& irradiance,
                 double share, const LampPatch& patch) const;

    /// A point of this lamp, the light of a volume: one with an intensity of its own [W/sr], the
    /// `share` of all light. `patch`: the part of the volume that it stands for.
    Lamp emitter(std::size_t index, const Point3& position, const Spectrum& intensity, double share,
                 const LampPatch& patch) const;

    /// The mirror image of this emitter, a point below a water surface that reflects: what reaches
    /// a point by way of the surface comes straight from the image, and is as bright as that is in
    /// its direction.
    Lamp mirrored(const WaterSurface& surface) const;

    /// The same emitter, but `factor` times as bright.
    Lamp brightened(double factor) const;

    const std::string& name() const { return name_; }
    /// Which of the scene's lamps it belongs to; 0 unless it is an emitter.
    std::size_t index() const { return index_; }
    /// The share of that lamp's light that comes from here.
    double share() const { return share_; }
    /// The same sun, focused by waves: in their light's mean direction, with the same irradiance on
    /// a level plane.
    Lamp focused(std::shared_ptr<const SunFocus> focus) const;
    bool is_focused() const { return focus_ != nullptr; }
    /// By what its light at `x` is multiplied where waves focus it (SunFocus); else 1.
    double focus(const Point3& x) const;
    /// Multiplies `values` by it, each at its distance `s` along a ray.
    void focus(const Ray& ray, std::span<const double> s, std::span<double> values) const;

    /// Whether it is a mirror image, above the surface.
    bool is_mirrored() const { return mirror_.has_value(); }
    /// Null unless it is a sun.
    const Sunlight* sunlight() const { return sunlight_ ? &*sunlight_ : nullptr; }
    /// Not of a sun.
    const Point3& position() const { return position_; }
    /// Where the light that reaches `x` comes from: the position; for a sun, the point of the
    /// water's surface through which it enters (below it, if `x` lies above).
    Point3 origin(const Point3& x) const { return sunlight_ ? sunlight_->entry(x) : position_; }
    /// Whether it is one of several that stand for parts of a luminous surface or a sun's disc: its
    /// shadows are soft (origin_on_patch). A lamp that consists of one point has hard ones.
    bool is_part() const { return patch_ && share_ < 1; }
    /// Where the light that reaches `x` comes from if it is that of one point of the patch, which
    /// belongs to a `place` in the unit square. Precondition: is_part().
    Point3 origin_on_patch(const Point3& x, const UnitPoint& place) const;
    /// The angle at which the radius of its patch is seen from this distance, if it is small; 0
    /// without a patch.
    double patch_angle(double distance) const {
        return patch_ ? patch_->radius / std::sqrt(spread(distance)) : 0;
    }
    /// By what its light is divided at a distance from its origin: R^2; 1 for a sun.
    double spread(double distance) const { return sunlight_ ? 1 : distance * distance; }
    /// distance_aside of a point of a lamp with an extent; 0 for all others.
    double aside(const Ray& ray) const {
        return patch_ && !sunlight_ ? distance_aside(position_, patch_->radius, ray) : 0;
    }
    /// Whether a point at this distance from its origin lies in the sphere that represents it.
    bool holds(double distance) const { return !sunlight_ && distance < k_lamp_radius; }
    /// Radiant intensity on the axis per band [W/sr]; for an IES profile, in the brightest
    /// direction; for a sun, irradiance [W/m^2].
    const Spectrum& axis_intensity() const { return axis_intensity_; }
    /// The name of its profile in reports: "spot".
    std::string_view profile_name() const;

    /// Intensity in the direction of `v` (from the origin, any length), relative to axis_intensity:
    /// 0..1. Of a sun, 0 above the water, where `v` points back.
    double relative_intensity(const Vector3& v) const;
    /// Whether a relative intensity of 1 at a point implies 1 everywhere around it, up to the next
    /// break of the profile (append_profile_breaks): the core of a spot.
    bool has_even_core() const;

    /// A cone outside which the lamp emits no light.
    DirectionCone cone() const;

    /// The part of the interval `stretch` of `ray` outside which the lamp emits no light; of length
    /// 0 where it misses the beam. It may still contain dark parts.
    Interval beam(const Ray& ray, const Interval& stretch) const;

    /// Appends distances along `ray` between which, within `stretch`, the profile is smooth and
    /// changes little (IsALampProfile); for a sun, the water's surface.
    void append_profile_breaks(const Ray& ray, const Interval& stretch,
                               std::vector<double>& s) const;

    /// Whether all that is known of them is the same.
    friend bool operator==(const Lamp&, const Lamp&) = default;

  private:
    void append_focus_breaks(const Ray& ray, const Interval& stretch, std::vector<double>& s) const;
    Interval below_surface(const Ray& ray, const Interval& stretch) const;

    std::string name_;
    Point3 position_;
    LampProfile profile_;
    Spectrum axis_intensity_{};
    std::optional<Sunlight> sunlight_;
    std::shared_ptr<const SunFocus> focus_;  // null: none
    std::optional<WaterSurface> mirror_;     // of an image, whose profile_ is that of the original
    std::size_t index_ = 0;
    double share_ = 1;
    std::optional<LampPatch> patch_;
};

}  // namespace uw
