#include "core/light/directional_emitter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace uw {

DirectionalEmitter::DirectionalEmitter(const Sunlight& sunlight, std::optional<LampPatch> patch)
    : Emitter(std::move(patch)), sunlight_(sunlight) {}

Interval DirectionalEmitter::beam(const Ray& ray, const Interval& interval) const {
    const double length = sunlight_.length_to(ray.origin);
    const double slope = sunlight_.slope(ray.direction);
    const Interval dark{interval.begin, interval.begin};
    if (slope == 0) return length > 0 ? interval : dark;
    const double crossing = -length / slope;
    const Interval below = slope > 0 ? Interval{std::max(interval.begin, crossing), interval.end}
                                     : Interval{interval.begin, std::min(interval.end, crossing)};
    return below.length() > 0 ? below : dark;
}

void DirectionalEmitter::append_profile_breaks(const Ray& ray, const Interval& /*interval*/,
                                               std::vector<double>& s) const {
    const double slope = sunlight_.slope(ray.direction);
    if (slope != 0) s.push_back(-sunlight_.length_to(ray.origin) / slope);
}

LampPassage DirectionalEmitter::passage(const Ray& ray) const {
    LampPassage passage;
    passage.parallel = true;
    passage.begin_length = sunlight_.length_to(ray.origin);
    passage.slope = sunlight_.slope(ray.direction);
    const double sine = glm::length(glm::cross(sunlight_.direction, ray.direction));
    const double cosine = -glm::dot(sunlight_.direction, ray.direction);  // of psi
    passage.tangent = cosine > 0 ? sine / (1 + cosine) : (1 - cosine) / sine;
    return passage;
}

Point3 DirectionalEmitter::origin_on_patch(const Point3& x, const UnitPoint& place) const {
    const Vector3 offset = patch()->at(place);
    // The square root is the cosine of the angle to the disc's centre.
    const Vector3 middle = glm::cross(patch()->frame.x, patch()->frame.y);
    return Sunlight::from_air(offset + std::sqrt(1 - glm::dot(offset, offset)) * middle,
                              sunlight_.surface)
        .entry(x);
}

bool DirectionalEmitter::equals(const Emitter& other) const {
    const auto& directional = static_cast<const DirectionalEmitter&>(other);
    return sunlight_ == directional.sunlight_ && patch() == directional.patch();
}

}  // namespace uw
