#include "core/integrators/ray_panels.h"

#include <algorithm>
#include <cmath>

namespace uw {

LampPassage::LampPassage(const Ray& ray, const Point3& lamp) {
    const Vector3 to_lamp = lamp - ray.origin;
    foot = glm::dot(to_lamp, ray.direction);
    distance = glm::length(to_lamp - foot * ray.direction);
}

void append_octaves(const LampPassage& passage, const Interval& interval, std::vector<double>& s) {
    const auto append = [&](double at) {
        if (at > interval.begin && at < interval.end) s.push_back(at);
    };
    append(passage.foot);
    const double reach =
        std::max(std::abs(interval.begin - passage.foot), std::abs(interval.end - passage.foot));
    for (double u = 0.75 * std::max(passage.distance, k_lamp_radius); u < reach; u *= 2) {
        append(passage.foot - u);
        append(passage.foot + u);
    }
}

}  // namespace uw
