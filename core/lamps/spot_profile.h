#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/ray.h"
#include "core/lamps/direction_cone.h"
#include "core/lamps/lamp_placement.h"
#include "core/scene/lamp_profile_desc.h"

namespace uw {

/// The profile of a spot: full in its core, 0 outside beam/2 + edge/2 of its axis, and with one of
/// several falloffs between (SpotProfileDesc::Falloff, IsALampProfile).
class SpotProfile {
  public:
    static constexpr std::string_view k_name = "spot";

    SpotProfile(const SpotProfileDesc& desc, const LampPlacement& placement);

    double relative_intensity(const Vector3& v) const;
    double solid_angle() const;
    std::optional<double> peak_candelas() const { return std::nullopt; }
    bool has_even_core() const { return falloff_ != SpotProfileDesc::Falloff::blender_3_4; }
    DirectionCone cone() const { return {axis_, cos_dark_}; }
    void append_breaks(const Ray& ray, const Interval& stretch, const Point3& apex,
                       std::vector<double>& s) const;

  private:
    Vector3 axis_;
    SpotProfileDesc::Falloff falloff_;
    double dark_angle_, cos_dark_;    // the spot is dark outside this angle [rad]
    double full_angle_, cos_full_;    // and shines fully inside this one
    std::vector<double> core_cones_;  // cosines at which the core has breaks, its edge included
};

inline SpotProfile make_profile(const SpotProfileDesc& desc, const LampPlacement& placement,
                                std::vector<std::string>& /*warnings*/) {
    return {desc, placement};
}

}  // namespace uw
