#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/light/profile_geometry.h"
#include "core/scene/lamp_desc.h"

namespace uw {

/// The profile of a line laser (IsALampProfile): a fan of light in a plane through the lamp. Across
/// that plane it is a Gaussian of the angle to it, cut off at twice its full width at half maximum,
/// where 2e-5 of it is left; along it, even up to the ends of the fan.
class LineProfile {
  public:
    static constexpr std::string_view k_name = "line";

    LineProfile(const LineProfileDesc& desc, const LampPlacement& placement);

    double relative_intensity(const Vector3& v) const;
    double solid_angle() const;
    std::optional<double> peak_candelas() const { return std::nullopt; }
    bool has_even_core() const { return false; }
    DirectionCone cone() const;
    void append_breaks(const Ray& ray, const Interval& interval, const Point3& apex,
                       std::vector<double>& s) const;

    Interval beam(const Ray& ray, const Interval& interval, const Point3& apex) const;
    FineStructure fine_structure() const { return {false, normal_}; }

    friend bool operator==(const LineProfile&, const LineProfile&) = default;

  private:
    void append_ends(const Ray& ray, const Point3& apex, std::vector<double>& s) const;

    Vector3 axis_, along_, normal_;  // unit, perpendicular to each other
    double half_angle_;              // of the fan [rad]
    double deviation_;               // of the Gaussian [rad]
    double dark_;                    // the angle from the plane at which it is cut off [rad]
};

inline LineProfile make_profile(const LineProfileDesc& desc, const LampPlacement& placement,
                                std::vector<std::string>& /*warnings*/) {
    return {desc, placement};
}

}  // namespace uw
