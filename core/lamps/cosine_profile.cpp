#include "core/lamps/cosine_profile.h"

#include <cmath>
#include <numbers>

#include "core/lamps/ray_crossings.h"

namespace uw {

CosineProfile::CosineProfile(const CosineProfileDesc& desc, const LampPlacement& placement)
    : axis_(placement.axis()),
      exponent_(std::log(0.5) / std::log(std::cos(glm::radians(0.5 * desc.fwhm)))) {
    // A cosine beam is smooth but may be narrow: break at cones of equal intensity.
    for (const double level : {0.95, 0.75, 0.5, 0.25, 0.1, 0.03, 0.003, 1e-4})
        cones_.push_back(std::pow(level, 1 / exponent_));
}

double CosineProfile::relative_intensity(const Vector3& v) const {
    const double cosine = glm::dot(v, axis_) / glm::length(v);
    return cosine <= 0 ? 0.0 : std::pow(cosine, exponent_);
}

double CosineProfile::solid_angle() const {
    return 2.0 * std::numbers::pi / (exponent_ + 1.0);
}

void CosineProfile::append_breaks(const Ray& ray, const Point3& apex,
                                  std::vector<double>& s) const {
    for (const double cosine : cones_) append_cone_crossings(ray, apex, axis_, cosine, s);
    append_plane_crossing(ray, apex, axis_, s);
}

}  // namespace uw
