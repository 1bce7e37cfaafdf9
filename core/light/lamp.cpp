#include "core/light/lamp.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "core/light/lamp_profile.h"
#include "core/light/sun_focus.h"

namespace uw {

Sunlight Sunlight::from_air(const Vector3& direction, const WaterSurfaceDesc& surface) {
    if (!surface.n) return {direction, surface};
    const WaterSurfaceDesc calm = without_waves(surface);
    return {WaterSurface(calm).into_water(direction), calm};
}

double squared_offset(const Point3& point, double patch_radius, const Ray& ray) {
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

Lamp Lamp::emitter(std::size_t index, const Vector3& direction, double fraction,
                   const std::optional<LampPatch>& patch) const {
    Lamp beam = emitter(index, position_, fraction, patch);
    beam.sunlight_->direction = direction;
    return beam;
}

Lamp Lamp::emitter(std::size_t index, const Vector3& direction, const Spectrum& irradiance,
                   double fraction, const LampPatch& patch) const {
    Lamp beam = emitter(index, direction, fraction, patch);
    beam.axis_intensity_ = irradiance;
    return beam;
}

Lamp Lamp::emitter(std::size_t index, const Point3& position, double fraction,
                   const std::optional<LampPatch>& patch) const {
    Lamp point = brightened(fraction);
    point.patch_ = patch;
    point.index_ = index;
    point.fraction_ = fraction;
    point.position_ = position;
    if (point.is_part() && !sunlight_)
        point.profile_ =
            softened(profile_, patch->centre + patch->middle() - position, patch->covariance());
    return point;
}

Lamp Lamp::emitter(std::size_t index, const Point3& position, const Spectrum& intensity,
                   double fraction, const LampPatch& patch) const {
    Lamp point = emitter(index, position, fraction, patch);
    point.axis_intensity_ = intensity;
    return point;
}

Lamp Lamp::mirrored(const WaterSurface& surface) const {
    Lamp image = *this;
    image.position_ = surface.mirrored(position_);
    image.mirror_ = surface;
    return image;
}

Lamp Lamp::focused(std::shared_ptr<const SunFocus> focus) const {
    const double calm = sunlight_->slope(sunlight_->surface.normal);
    Lamp sun = *this;
    sun.sunlight_->direction = focus->direction();
    sun.focus_ = std::move(focus);
    return sun.brightened(sun.sunlight_->slope(sun.sunlight_->surface.normal) / calm);
}

double Lamp::focus(const Point3& x) const {
    return focus_ ? focus_->at(x) : 1;
}

void Lamp::focus(const Ray& ray, std::span<const double> s, std::span<double> values) const {
    if (focus_) focus_->apply(ray, s, values);
}

Lamp Lamp::brightened(double factor) const {
    Lamp lamp = *this;
    for (double& value : lamp.axis_intensity_) value *= factor;
    return lamp;
}

Point3 Lamp::origin_on_patch(const Point3& x, const UnitPoint& place) const {
    const Vector3 offset = patch_->at(place);
    if (mirror_) return mirror_->mirrored(patch_->centre + offset);
    if (!sunlight_) return patch_->centre + offset;
    // The square root is the cosine of the angle to the disc's centre.
    const Vector3 middle = glm::cross(patch_->frame.x, patch_->frame.y);
    return Sunlight::from_air(offset + std::sqrt(1 - glm::dot(offset, offset)) * middle,
                              sunlight_->surface)
        .entry(x);
}

std::string_view Lamp::profile_name() const {
    if (sunlight_) return "sun";
    return std::visit([](const auto& profile) { return profile.k_name; }, profile_);
}

double Lamp::relative_intensity(const Vector3& v) const {
    if (sunlight_) return glm::dot(v, sunlight_->direction) > 0 ? 1 : 0;
    if (mirror_) {
        const double down = -glm::dot(v, mirror_->up());
        if (!(down > 0)) return 0;
        const Vector3 original = mirror_->mirrored(v);
        return mirror_->reflectance_from_water(down / glm::length(v)) *
               std::visit([&](const auto& profile) { return profile.relative_intensity(original); },
                          profile_);
    }
    return std::visit([&](const auto& profile) { return profile.relative_intensity(v); }, profile_);
}

bool Lamp::is_soft() const {
    return std::holds_alternative<SoftSpotProfile>(profile_);
}

bool Lamp::has_even_core() const {
    return !mirror_ &&
           std::visit([](const auto& profile) { return profile.has_even_core(); }, profile_);
}

DirectionCone Lamp::cone() const {
    DirectionCone cone = std::visit([](const auto& profile) { return profile.cone(); }, profile_);
    if (mirror_) cone.axis = mirror_->mirrored(cone.axis);
    return cone;
}

Interval Lamp::beam(const Ray& ray, const Interval& interval) const {
    if (sunlight_) return below_surface(ray, interval);
    const DirectionCone lit_cone = cone();
    if (!(interval.length() > 0) || lit_cone.has_all()) return interval;
    thread_local std::vector<double> cuts;
    cuts.clear();
    append_cone_crossings(ray, position_, lit_cone.axis, lit_cone.cosine, cuts);
    std::erase_if(cuts, [&](double s) { return s <= interval.begin || s >= interval.end; });
    cuts.push_back(interval.begin);
    cuts.push_back(interval.end);
    std::sort(cuts.begin(), cuts.end());
    // The cone is not crossed between two cuts: a segment lies entirely inside or outside.
    Interval lit{interval.begin, interval.begin};
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const Vector3 middle = ray.at(0.5 * (cuts[i] + cuts[i + 1])) - position_;
        if (glm::dot(middle, lit_cone.axis) < lit_cone.cosine * glm::length(middle)) continue;
        if (lit.length() == 0) lit.begin = cuts[i];
        lit.end = cuts[i + 1];
    }
    return lit;
}

Interval Lamp::below_surface(const Ray& ray, const Interval& interval) const {
    const double length = sunlight_->length_to(ray.origin);
    const double slope = sunlight_->slope(ray.direction);
    const Interval dark{interval.begin, interval.begin};
    if (slope == 0) return length > 0 ? interval : dark;
    const double crossing = -length / slope;
    const Interval below = slope > 0 ? Interval{std::max(interval.begin, crossing), interval.end}
                                     : Interval{interval.begin, std::min(interval.end, crossing)};
    return below.length() > 0 ? below : dark;
}

// Breaks at every fourth texel, and at wider steps farther away, where a pixel covers more texels.
void Lamp::append_focus_breaks(const Ray& ray, const Interval& interval,
                               std::vector<double>& s) const {
    constexpr double k_texels = 4, k_relative_step = 0.02;
    const double least = k_texels * focus_->texel() / std::max(1e-3, focus_->slide(ray.direction));
    for (double at = interval.begin + least; at < interval.end;
         at += std::max(least, k_relative_step * at))
        s.push_back(at);
}

void Lamp::append_profile_breaks(const Ray& ray, const Interval& interval,
                                 std::vector<double>& s) const {
    if (sunlight_) {
        const double slope = sunlight_->slope(ray.direction);
        if (slope != 0) s.push_back(-sunlight_->length_to(ray.origin) / slope);
        if (focus_) append_focus_breaks(ray, interval, s);
        return;
    }
    const auto append_breaks = [&](const Ray& line, const Point3& from) {
        std::visit([&](const auto& profile) { profile.append_breaks(line, interval, from, s); },
                   profile_);
    };
    if (!mirror_) {
        append_breaks(ray, position_);
        return;
    }
    append_breaks(mirror_->mirrored(ray), mirror_->mirrored(position_));
    // The reflectance rises like a square root of the angle up to total reflection, hence the ever
    // shorter steps towards the critical angle.
    const double critical = mirror_->critical_cosine(), square = critical * critical;
    for (const double step : {0.0, 1.0 / 256, 1.0 / 64, 1.0 / 16, 1.0 / 4})
        append_cone_crossings(ray, position_, -mirror_->up(),
                              std::sqrt(square + step * (1 - square)), s);
}

}  // namespace uw
