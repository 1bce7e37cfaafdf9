#include "render/snow/snow_lighting.h"

#include <algorithm>
#include <cmath>

#include "core/snow/lambert_sphere.h"

namespace uw {

void SnowLighting::radiance(const Point3& x, const Ray& ray, double distance,
                            std::span<double> radiance) const {
    const std::vector<Lamp>& emitters = *scene_.emitters;
    const std::size_t constituents = scene_.medium->constituents.size();
    thread_local std::vector<double> to_camera, column;
    to_camera.assign(constituents, 0.0);
    column.resize(constituents);
    if (constituents > 0) scene_.field->column(ray.origin, x, to_camera);
    std::ranges::fill(radiance, 0.0);
    for (std::size_t j = 0; j < emitters.size(); ++j) {
        const Lamp& lamp = emitters[j];
        const Point3 origin = lamp.origin(x);
        const Vector3 from_lamp = x - origin;
        const double radius = glm::length(from_lamp);
        const double relative = lamp.relative_intensity(from_lamp);
        if (lamp.holds(radius) || relative <= 0 || scene_.surfaces->occluded(origin, x)) continue;
        if (constituents > 0) {
            if (deep_shadows_.empty())
                scene_.field->column(origin, x, column);
            else
                deep_shadows_[j]->columns(std::span<const Point3>(&x, 1), column);
            add(column, to_camera);
        }
        const double psi = std::atan2(glm::length(glm::cross(from_lamp, ray.direction)),
                                      -glm::dot(from_lamp, ray.direction));
        const double factor = relative / lamp.spread(radius) * LambertSphere::at(psi);
        for (std::size_t b = 0; b < radiance.size(); ++b)
            radiance[b] += factor * lamp.axis_intensity()[b] *
                           std::exp(-attenuation_.optical_depth(b, radius + distance, column));
    }
}

}  // namespace uw
