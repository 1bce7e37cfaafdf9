#pragma once

#include <string>
#include <vector>

#include "core/bands.h"
#include "core/ray.h"
#include "core/scene_desc.h"

namespace uw {

/// A lamp counts as a sphere this large: no in-scatter is gathered inside, where 1/r^2 of a point
/// would grow without bound [m].
inline constexpr double k_lamp_radius = 1e-3;

/// The directions within an angle of an axis.
struct DirectionCone {
    Vector3 axis{0, 0, 1};  // unit
    double cosine = -1;     // of the angle; -1: all directions

    bool has_all() const { return cosine <= -1; }
    bool has(const Vector3& direction) const {
        return has_all() || glm::dot(direction, axis) >= cosine * glm::length(direction);
    }
    /// All directions within `angle` [rad] of this cone's.
    DirectionCone widened(double angle) const;
    bool includes(const DirectionCone& other) const;
};

/// A point-like lamp in the world: radiant intensity I(w, lambda) = intensity * profile(w) [W/sr].
class Lamp {
  public:
    /// Builds the lamp from its description; `world_from_camera` places lamps fixed to the camera.
    Lamp(const LampDesc& desc, const class Affine& world_from_camera, int band_count);

    const std::string& name() const { return name_; }
    const Point3& position() const { return position_; }
    /// Radiant intensity on the axis per band [W/sr].
    const Spectrum& axis_intensity() const { return axis_intensity_; }

    /// Intensity in the direction of `v` (from the lamp, any length), relative to the axis: 0..1.
    double relative_intensity(const Vector3& v) const;
    /// Whether a relative intensity of 1 somewhere means 1 all around, up to a break of the profile
    /// (append_profile_breaks): the core of a spot.
    bool has_even_core() const { return profile_.type != LampProfileDesc::Type::cosine; }
    /// Power of the lamp for 1 W/sr on its axis: its relative intensity over the sphere [sr].
    double beam_solid_angle() const;

    /// Directions beyond which the lamp shines nothing.
    DirectionCone cone() const { return {axis_, cos_dark_}; }

    /// The part of a stretch of `ray` outside which the lamp shines nothing; of length 0 where it
    /// misses the beam. What is left may have dark parts.
    Interval beam(const Ray& ray, const Interval& stretch) const;

    /// Appends the distances along `ray` where the profile is not smooth or changes much: the edges
    /// of its beam and cones of equal intensity within.
    void append_profile_breaks(const Ray& ray, std::vector<double>& s) const;

  private:
    std::string name_;
    Point3 position_;
    Vector3 axis_;
    LampProfileDesc profile_;
    double full_angle_ = 0, cos_full_ = 1;   // a spot shines fully inside this angle [rad]
    double dark_angle_ = 0, cos_dark_ = -1;  // and is dark outside this one
    double exponent_ = 0;                    // of cos^m
    std::vector<double> cones_;              // cosines of the cones that break the profile
    Spectrum axis_intensity_{};
};

}  // namespace uw
