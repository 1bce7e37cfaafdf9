#include "core/light/point_emitter.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace uw {

double squared_offset(const Point3& point, double patch_radius, const Ray& ray) {
    const Vector3 across = glm::cross(point - ray.origin, ray.direction);
    const double patch = patch_radius * patch_radius, ratio = glm::dot(across, across) / patch;
    const double left = 1 - ratio / 9;
    return left > 0 ? 0.36 * patch * (1 - 2.1983 * ratio) * left * left : 0;
}

Interval beam_of(const DirectionCone& cone, const Point3& apex, const Ray& ray,
                 const Interval& interval) {
    if (!(interval.length() > 0) || cone.has_all()) return interval;
    std::vector<double> cuts;
    cuts.reserve(4);  // two of them are ends
    append_cone_crossings(ray, apex, cone.axis, cone.cosine, cuts);
    return lit_part(ray, interval, cuts, [&](const Point3& x) {
        const Vector3 v = x - apex;
        return glm::dot(v, cone.axis) >= cone.cosine * glm::length(v);
    });
}

LampPassage passage_of(const Point3& point, double squared_offset, const Ray& ray) {
    LampPassage passage(ray, point);
    if (squared_offset != 0)
        passage.distance = std::sqrt(passage.distance * passage.distance + squared_offset);
    return passage;
}

PointEmitter::PointEmitter(const Point3& position, LampProfile profile,
                           std::optional<LampPatch> patch)
    : Emitter(patch), position_(position), profile_(std::move(profile)) {}

std::string_view PointEmitter::profile_name() const {
    return std::visit([](const auto& profile) { return profile.k_name; }, profile_);
}

double PointEmitter::relative_intensity(const Vector3& v) const {
    return std::visit([&](const auto& profile) { return profile.relative_intensity(v); }, profile_);
}

bool PointEmitter::has_even_core() const {
    return std::visit([](const auto& profile) { return profile.has_even_core(); }, profile_);
}

DirectionCone PointEmitter::cone() const {
    return std::visit([](const auto& profile) { return profile.cone(); }, profile_);
}

Interval PointEmitter::beam(const Ray& ray, const Interval& interval) const {
    const auto beam_of_profile = [&](const auto& profile) {
        const Interval in_cone = beam_of(profile.cone(), position_, ray, interval);
        if constexpr (requires { profile.beam(ray, in_cone, position_); })
            return profile.beam(ray, in_cone, position_);
        else
            return in_cone;
    };
    return std::visit(beam_of_profile, profile_);
}

FineStructure PointEmitter::fine_structure() const {
    const auto fine_structure_of = [](const auto& profile) -> FineStructure {
        if constexpr (requires { profile.fine_structure(); })
            return profile.fine_structure();
        else
            return {};
    };
    return std::visit(fine_structure_of, profile_);
}

void PointEmitter::append_profile_breaks(const Ray& ray, const Interval& interval,
                                         std::vector<double>& s) const {
    std::visit([&](const auto& profile) { profile.append_breaks(ray, interval, position_, s); },
               profile_);
}

double PointEmitter::squared_offset(const Ray& ray) const {
    return patch() ? uw::squared_offset(position_, patch()->radius, ray) : 0;
}

Point3 PointEmitter::origin_on_patch(const Point3& /*x*/, const UnitPoint& place) const {
    return patch()->centre + patch()->at(place);
}

bool PointEmitter::equals(const Emitter& other) const {
    const auto& point = static_cast<const PointEmitter&>(other);
    return position_ == point.position_ && profile_ == point.profile_ && patch() == point.patch();
}

}  // namespace uw
