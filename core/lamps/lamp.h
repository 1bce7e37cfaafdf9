#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/lamps/photometric_web.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// A lamp counts as a sphere this large: no in-scatter is gathered inside, where 1/r^2 of a point
/// would grow without bound [m].
inline constexpr double k_lamp_radius = 1e-3;

/// The directions within an angle of an axis.
struct DirectionCone {
    Vector3 axis{0, 0, 1};  // unit
    double cosine = -1;     // of the angle; -1: all directions

    bool has_all() const { return cosine <= -1; }
    /// `direction`: of any length.
    bool has(const Vector3& direction) const {
        if (has_all()) return true;  // rounding has no say
        const double along = glm::dot(direction, axis);
        const double edge = cosine * cosine * glm::dot(direction, direction);  // of along^2
        return cosine >= 0 ? along >= 0 && along * along >= edge
                           : along >= 0 || along * along <= edge;
    }
    /// All directions within `angle` [rad] of this cone's.
    DirectionCone widened(double angle) const;
    bool includes(const DirectionCone& other) const;
};

/// A point-like lamp in the world: radiant intensity I(w, lambda) = intensity * profile(w) [W/sr].
class Lamp {
  public:
    /// Builds the lamp from its description, in which exactly one of intensity and power is set and
    /// there is no spectrum (media/lamp_factory.h makes it so); `world_from_camera` places lamps
    /// fixed to the camera. `web`: the photometry of a profile of type ies, none of others.
    Lamp(const LampDesc& desc, const class Affine& world_from_camera, int band_count,
         std::shared_ptr<const PhotometricWeb> web = nullptr);

    const std::string& name() const { return name_; }
    const Point3& position() const { return position_; }
    /// Radiant intensity on the axis per band [W/sr]; of an IES profile, where it is brightest.
    const Spectrum& axis_intensity() const { return axis_intensity_; }

    /// Intensity in the direction of `v` (from the lamp, any length), relative to axis_intensity:
    /// 0..1.
    double relative_intensity(const Vector3& v) const;
    /// Whether a relative intensity of 1 somewhere means 1 all around, up to a break of the profile
    /// (append_profile_breaks): the core of a spot.
    bool has_even_core() const {
        return profile_.type == LampProfileDesc::Type::isotropic ||
               profile_.type == LampProfileDesc::Type::spot;
    }
    /// Power of the lamp for an axis_intensity of 1 W/sr: its relative intensity over the sphere
    /// [sr].
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
    void place_spot();
    void place_cosine();
    void place_web(const Affine& world_from_frame, const Vector3& direction);
    double web_intensity(const Vector3& v) const;

    std::string name_;
    Point3 position_;
    Vector3 axis_;
    LampProfileDesc profile_;
    double full_angle_ = 0, cos_full_ = 1;       // a spot shines fully inside this angle [rad]
    double dark_angle_ = 0, cos_dark_ = -1;      // and is dark outside this one
    double exponent_ = 0;                        // of cos^m
    std::vector<double> cones_;                  // cosines of the cones that break the profile
    bool breaks_at_equator_ = false;             // the plane across the axis breaks it, too
    std::shared_ptr<const PhotometricWeb> web_;  // of an IES profile
    Vector3 zero_{0.0}, quarter_{0.0};           // its azimuths 0 and 90 degrees, across the axis
    std::vector<Vector3> half_planes_;  // directions across the axis that break the profile
    Spectrum axis_intensity_{};
};

}  // namespace uw
