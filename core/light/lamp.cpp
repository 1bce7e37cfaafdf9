#include "core/light/lamp.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "core/light/lamp_profile.h"

namespace uw {

double distance_aside(const Point3& point, double patch_radius, const Ray& ray) {
    const Vector3 across = glm::cross(point - ray.origin, ray.direction);
    const double patch = patch_radius * patch_radius, ratio = glm::dot(across, across) / patch;
    const double left = 1 - ratio / 9;
    return left > 0 ? 0.36 * patch * (1 - 2.1983 * ratio) * left * left : 0;
}

Lamp::Lamp(std::string name, const Point3& position, LampProfile profile,
           const Spectrum& axis_intensity)
    : name_(std::move(name)),
      position_(position),
      profile_(std::move(profile)),
      axis_intensity_(axis_intensity) {}

Lamp::Lamp(std::string name, const Sunlight& sunlight, const Spectrum& irradiance)
    : Lamp(std::move(name), sunlight.surface.point, IsotropicProfile{}, irradiance) {
    sunlight_ = sunlight;
}

Lamp Lamp::emitter(std::size_t index, const Vector3& direction, double share,
                   const std::optional<LampPatch>& patch) const {
    Lamp beam = emitter(index, position_, share, patch);
    beam.sunlight_->direction = direction;
    return beam;
}

Lamp Lamp::emitter(std::size_t index, const Point3& position, double share,
                   const std::optional<LampPatch>& patch) const {
    Lamp point = brightened(share);
    point.patch_ = patch;
    point.index_ = index;
    point.share_ = share;
    point.position_ = position;
    return point;
}

Lamp Lamp::emitter(std::size_t index, const Point3& position, const Spectrum& intensity,
                   double share, const LampPatch& patch) const {
    Lamp point = emitter(index, position, share, patch);
    point.axis_intensity_ = intensity;
    return point;
}

Lamp Lamp::brightened(double factor) const {
    Lamp lamp = *this;
    for (double& value : lamp.axis_intensity_) value *= factor;
    return lamp;
}

Point3 Lamp::origin_on_patch(const Point3& x, const UnitPoint& place) const {
    const Vector3 aside = patch_->at(place);
    if (!sunlight_) return patch_->centre + aside;
    // The square root is the cosine of the angle to the disc's middle.
    const Vector3 middle = glm::cross(patch_->frame.x, patch_->frame.y);
    const Sunlight there{aside + std::sqrt(1 - glm::dot(aside, aside)) * middle,
                         sunlight_->surface};
    return there.entry(x);
}

std::string_view Lamp::profile_name() const {
    if (sunlight_) return "sun";
    return std::visit([](const auto& profile) { return profile.k_name; }, profile_);
}

double Lamp::relative_intensity(const Vector3& v) const {
    if (sunlight_) return glm::dot(v, sunlight_->direction) > 0 ? 1 : 0;
    return std::visit([&](const auto& profile) { return profile.relative_intensity(v); }, profile_);
}

bool Lamp::has_even_core() const {
    return std::visit([](const auto& profile) { return profile.has_even_core(); }, profile_);
}

DirectionCone Lamp::cone() const {
    return std::visit([](const auto& profile) { return profile.cone(); }, profile_);
}

Interval Lamp::beam(const Ray& ray, const Interval& stretch) const {
    if (sunlight_) return below_surface(ray, stretch);
    const DirectionCone lit_cone = cone();
    if (!(stretch.length() > 0) || lit_cone.has_all()) return stretch;
    thread_local std::vector<double> cuts;
    cuts.clear();
    append_cone_crossings(ray, position_, lit_cone.axis, lit_cone.cosine, cuts);
    std::erase_if(cuts, [&](double s) { return s <= stretch.begin || s >= stretch.end; });
    cuts.push_back(stretch.begin);
    cuts.push_back(stretch.end);
    std::sort(cuts.begin(), cuts.end());
    // The cone is not crossed between two cuts: a segment lies entirely inside or outside.
    Interval lit{stretch.begin, stretch.begin};
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const Vector3 middle = ray.at(0.5 * (cuts[i] + cuts[i + 1])) - position_;
        if (glm::dot(middle, lit_cone.axis) < lit_cone.cosine * glm::length(middle)) continue;
        if (lit.length() == 0) lit.begin = cuts[i];
        lit.end = cuts[i + 1];
    }
    return lit;
}

Interval Lamp::below_surface(const Ray& ray, const Interval& stretch) const {
    const double length = sunlight_->length_to(ray.origin);
    const double slope = sunlight_->slope(ray.direction);
    const Interval dark{stretch.begin, stretch.begin};
    if (slope == 0) return length > 0 ? stretch : dark;
    const double crossing = -length / slope;
    const Interval below = slope > 0 ? Interval{std::max(stretch.begin, crossing), stretch.end}
                                     : Interval{stretch.begin, std::min(stretch.end, crossing)};
    return below.length() > 0 ? below : dark;
}

void Lamp::append_profile_breaks(const Ray& ray, const Interval& stretch,
                                 std::vector<double>& s) const {
    if (sunlight_) {
        const double slope = sunlight_->slope(ray.direction);
        if (slope != 0) s.push_back(-sunlight_->length_to(ray.origin) / slope);
        return;
    }
    std::visit([&](const auto& profile) { profile.append_breaks(ray, stretch, position_, s); },
               profile_);
}

}  // namespace uw
