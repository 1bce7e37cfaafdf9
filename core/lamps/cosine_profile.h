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

/// The profile cos^m of the angle from the axis, 1/2 at fwhm/2 and 0 behind the lamp
/// (IsALampProfile).
class CosineProfile {
  public:
    static constexpr std::string_view k_name = "cosine";

    CosineProfile(const CosineProfileDesc& desc, const LampPlacement& placement);

    double relative_intensity(const Vector3& v) const;
    double solid_angle() const;
    std::optional<double> peak_candelas() const { return std::nullopt; }
    bool has_even_core() const { return false; }
    /// All directions: a half-space is too wide to be worth restricting the search.
    DirectionCone cone() const { return {axis_, -1}; }
    void append_breaks(const Ray& ray, const Interval& stretch, const Point3& apex,
                       std::vector<double>& s) const;

  private:
    Vector3 axis_;
    double exponent_;  // m
    // Ratios of the cosines at which it has breaks along a ray to the greatest one on it.
    std::vector<double> break_ratios_;
};

inline CosineProfile make_profile(const CosineProfileDesc& desc, const LampPlacement& placement,
                                  std::vector<std::string>& /*warnings*/) {
    return {desc, placement};
}

}  // namespace uw
