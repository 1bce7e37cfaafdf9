#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/ray.h"
#include "core/lamps/direction_cone.h"
#include "core/lamps/lamp_placement.h"
#include "core/scene/lamp_profile_desc.h"

namespace uw {

/// The profile of a lamp that is equally bright in all directions (IsALampProfile).
class IsotropicProfile {
  public:
    static constexpr std::string_view k_name = "isotropic";

    double relative_intensity(const Vector3& /*v*/) const { return 1.0; }
    double solid_angle() const { return 4.0 * std::numbers::pi; }
    std::optional<double> peak_candelas() const { return std::nullopt; }
    bool has_even_core() const { return true; }
    DirectionCone cone() const { return {}; }
    void append_breaks(const Ray& /*ray*/, const Interval& /*stretch*/, const Point3& /*apex*/,
                       std::vector<double>& /*s*/) const {}
};

inline IsotropicProfile make_profile(const IsotropicProfileDesc& /*desc*/,
                                     const LampPlacement& /*placement*/,
                                     std::vector<std::string>& /*warnings*/) {
    return {};
}

}  // namespace uw
