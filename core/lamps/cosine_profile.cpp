#include "core/lamps/cosine_profile.h"

#include <cmath>
#include <numbers>

#include "core/lamps/ray_crossings.h"

namespace uw {

namespace {

constexpr int k_breaks = 8;  // to either side of where a ray is brightest: down to 4e-5 of it
// What a ray may be lit by at least, relative to the axis, to be worth any breaks.
constexpr double k_negligible = 1e-12;

}  // namespace

CosineProfile::CosineProfile(const CosineProfileDesc& desc, const LampPlacement& placement)
    : axis_(placement.axis()),
      exponent_(std::log(0.5) / std::log(std::cos(glm::radians(0.5 * desc.fwhm)))) {
    // A cosine beam is smooth but may be narrow: across it a ray sees very nearly a Gaussian, as
    // wide wherever it passes. Break it at odd multiples of 0.3 standard deviations.
    for (int i = 0; i < k_breaks; ++i) {
        const double deviations = 0.3 * (2 * i + 1);
        break_ratios_.push_back(std::exp(-0.5 * deviations * deviations / exponent_));
    }
}

double CosineProfile::relative_intensity(const Vector3& v) const {
    const double cosine = glm::dot(v, axis_) / glm::length(v);
    return cosine <= 0 ? 0.0 : std::pow(cosine, exponent_);
}

double CosineProfile::solid_angle() const {
    return 2.0 * std::numbers::pi / (exponent_ + 1.0);
}

void CosineProfile::append_breaks(const Ray& ray, const Interval& stretch, const Point3& apex,
                                  std::vector<double>& s) const {
    const double greatest = approach_to_axis(ray, stretch, apex, axis_).cosine;
    if (greatest <= 0 || std::pow(greatest, exponent_) < k_negligible) return;
    for (const double ratio : break_ratios_)
        append_cone_crossings(ray, apex, axis_, greatest * ratio, s);
    append_plane_crossing(ray, apex, axis_, s);
}

}  // namespace uw
