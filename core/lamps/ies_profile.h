#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/ray.h"
#include "core/lamps/direction_cone.h"
#include "core/lamps/lamp_placement.h"
#include "core/lamps/photometric_web.h"
#include "core/scene/lamp_profile_desc.h"

namespace uw {

/// The profile of a luminaire given by its photometry, relative to its brightest direction
/// (IsALampProfile).
///
/// Azimuth 0 points towards the frame's x axis (its y axis if the lamp shines along x), projected
/// along the lamp's direction; `rotate` turns it about that direction, then `tilt` tilts the
/// luminaire's axis from that direction towards it. Azimuth 90 degrees lies anticlockwise of 0 seen
/// from behind the lamp, as in LM-63.
class IesProfile {
  public:
    static constexpr std::string_view k_name = "IES luminaire";

    /// `web` is the photometry of `desc.file`.
    IesProfile(const IesProfileDesc& desc, const LampPlacement& placement,
               std::shared_ptr<const PhotometricWeb> web);

    double relative_intensity(const Vector3& v) const;
    double solid_angle() const { return web_->flux() / web_->peak(); }
    std::optional<double> peak_candelas() const { return web_->peak(); }
    bool has_even_core() const { return false; }
    DirectionCone cone() const { return {axis_, cos_dark_}; }
    void append_breaks(const Ray& ray, const Interval& stretch, const Point3& apex,
                       std::vector<double>& s) const;

  private:
    std::shared_ptr<const PhotometricWeb> web_;
    Vector3 axis_, zero_, quarter_;   // its axis, and azimuths 0 and 90 degrees perpendicular to it
    double cos_dark_;                 // dark outside this angle from the axis
    std::vector<double> cones_;       // cosines of the cones at which the profile has breaks
    bool breaks_at_equator_ = false;  // whether it also has one at the plane normal to the axis
    std::vector<Vector3> half_planes_;  // azimuthal directions at which the profile has breaks
};

/// Reads the file. Adds a one-line warning if its candelas are inconsistent with its lumens. Throws
/// InputError for a file that is not LM-63, IoError for one that cannot be read.
IesProfile make_profile(const IesProfileDesc& desc, const LampPlacement& placement,
                        std::vector<std::string>& warnings);

}  // namespace uw
