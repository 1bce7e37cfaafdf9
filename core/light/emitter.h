#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <typeinfo>
#include <utility>
#include <vector>

#include "core/base/ray.h"
#include "core/base/vector_math.h"
#include "core/light/lamp_passage.h"
#include "core/light/lamp_patch.h"
#include "core/light/lamp_profile.h"

namespace uw {

struct Sunlight;

/// Radius of the sphere that represents a lamp: no in-scatter is gathered inside, where the 1/r^2
/// of a point source would grow without bound [m].
inline constexpr double k_lamp_radius = 1e-3;

/// A source of light without an extent, in the world. The light that reaches x comes in a straight
/// line from origin(x), R away, and its irradiance on a plane perpendicular to it would be
/// I * relative_intensity(x - origin(x)) * focus(x) / spread(R) without water. The factor I is not
/// its own (Lamp::axis_intensity).
///
/// There are points (PointEmitter) and parallel light (DirectionalEmitter), which waves may focus
/// (FocusedEmitter), and the mirror image of another emitter (MirroredEmitter). None of them ever
/// changes. `tests/support/emitter_laws.h` has the laws that all obey.
class Emitter {
  public:
    virtual ~Emitter() = default;

    /// The name of its profile in reports: "spot".
    virtual std::string_view profile_name() const = 0;

    /// The origin of the light that reaches `x`: a position; for parallel light, the point of the
    /// water's surface through which it enters (a point below `x` if `x` lies above the surface).
    virtual Point3 origin(const Point3& x) const = 0;
    /// The divisor of its light at a distance R from its origin: R^2; 1 for parallel light.
    virtual double spread(double distance) const = 0;
    /// Whether a point at this distance from its origin lies in the sphere that represents it.
    virtual bool contains(double distance) const = 0;
    /// Intensity in the direction of `v`, relative to the greatest: 0..1. `v` leads from the origin
    /// to where it is evaluated; its length counts only for soft profiles (SoftSpotProfile).
    /// Parallel light has 0 above the water, where `v` points against it.
    virtual double relative_intensity(const Vector3& v) const = 0;

    /// The factor by which waves focus its light at `x` (SunFocus), and by which glass on the way
    /// dims it (GlassShadedEmitter); 1 if nothing does.
    virtual double focus(const Point3& /*x*/) const { return 1; }
    /// Multiplies each of `values` by that factor at its distance `s` along a ray.
    virtual void focus(const Ray& /*ray*/, std::span<const double> /*s*/,
                       std::span<double> /*values*/) const {}
    /// Whether waves focus its light.
    virtual bool is_focused() const { return false; }

    /// Whether a relative intensity of 1 at a point implies 1 everywhere around it, up to the next
    /// break of the profile (append_profile_breaks): the core of a spot.
    virtual bool has_even_core() const = 0;
    /// Whether the profile may end between two of its breaks, as that of a part of a spot does
    /// (SoftSpotProfile).
    virtual bool is_soft() const { return false; }
    /// A cone outside which it emits no light.
    virtual DirectionCone cone() const = 0;
    /// What in that cone is narrow.
    virtual FineStructure fine_structure() const { return {}; }
    /// The part of the interval `interval` of `ray` outside which it emits no light; of length 0
    /// where it misses the beam. It may still contain dark parts.
    virtual Interval beam(const Ray& ray, const Interval& interval) const = 0;
    /// Appends distances along `ray` between which, within `interval`, the light is smooth and
    /// changes little (IsALampProfile); for parallel light, the water's surface.
    virtual void append_profile_breaks(const Ray& ray, const Interval& interval,
                                       std::vector<double>& s) const = 0;

    /// The geometry of a ray that passes it.
    virtual LampPassage passage(const Ray& ray) const = 0;
    /// uw::squared_offset for a point of a lamp with an extent [m^2]; 0 for all others.
    virtual double squared_offset(const Ray& /*ray*/) const { return 0; }

    /// The part of a luminous surface, or of a sun's disc or the sky, that it represents; none: it
    /// has no extent.
    const std::optional<LampPatch>& patch() const { return patch_; }
    /// The origin of the light that reaches `x` from the point of the patch to which `place` in the
    /// unit cube maps. Precondition: it has a patch.
    virtual Point3 origin_on_patch(const Point3& x, const UnitPoint& place) const = 0;
    /// The angle that the radius of its patch subtends at this distance, to first order; 0 without
    /// a patch.
    double patch_angle(double distance) const {
        return patch_ ? patch_->radius / std::sqrt(spread(distance)) : 0;
    }

    /// Its parallel light; null for all that has a position.
    virtual const Sunlight* sunlight() const { return nullptr; }
    /// Whether it is a mirror image, above the surface.
    virtual bool is_mirrored() const { return false; }

    /// Whether both are of the same class and have equal members.
    friend bool operator==(const Emitter& a, const Emitter& b) {
        return typeid(a) == typeid(b) && a.equals(b);
    }

  protected:
    explicit Emitter(std::optional<LampPatch> patch) : patch_(patch) {}
    Emitter(const Emitter&) = default;
    Emitter(Emitter&&) = default;
    Emitter& operator=(const Emitter&) = default;
    Emitter& operator=(Emitter&&) = default;

    /// Precondition: `other` is of the same class.
    virtual bool equals(const Emitter& other) const = 0;

  private:
    std::optional<LampPatch> patch_;
};

}  // namespace uw
