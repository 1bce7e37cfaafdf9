#include "core/passes/mirrored_view.h"

#include <vector>

#include "core/geometry/water_surface.h"

namespace uw {

MirroredView::MirroredView(const RaySource& rays, const LitScene& scene)
    : rays_(rays), scene_(scene), attenuation_(*scene.medium) {}

bool MirroredView::may_see(const RaySource& rays, const WaterSurface& surface) {
    constexpr int k_steps = 32;
    for (int j = 0; j <= k_steps; ++j) {
        for (int i = 0; i <= k_steps; ++i) {
            const std::optional<Ray> ray =
                rays.refracted_ray(static_cast<double>(i) / k_steps * rays.width(),
                                   static_cast<double>(j) / k_steps * rays.height());
            if (ray && surface.crossing(*ray)) return true;
        }
    }
    return false;
}

double MirroredView::distance_to_surface(const Ray& ray) const {
    SurfaceHit hit;
    const bool meets_it = scene_.water_surface->crossing(ray) &&
                          scene_.surfaces->closest_hit(ray, k_far, hit) && hit.is_water_surface;
    return meets_it ? hit.distance : k_far;
}

std::optional<Ray> MirroredView::mirrored(const std::optional<Ray>& ray) const {
    if (!ray) return std::nullopt;
    const double distance = distance_to_surface(*ray);
    if (!(distance < k_far)) return std::nullopt;
    return Ray{ray->at(distance), scene_.water_surface->mirrored(ray->direction)};
}

Spectrum MirroredView::arriving(int x, int y) const {
    // The centre tells for the whole pixel; at the edge of something else, any place that does not
    // see that.
    constexpr int k_places = 4;
    double distance = k_far;
    Ray seen;
    const auto look = [&](double across, double down) {
        const std::optional<Ray> ray = rays_.refracted_ray(x + across, y + down);
        if (!ray) return;
        seen = *ray;
        distance = distance_to_surface(seen);
    };
    look(0.5, 0.5);
    for (int k = 0; k < k_places * k_places && !(distance < k_far); ++k)
        look((k % k_places + 0.5) / k_places, (k / k_places + 0.5) / k_places);
    if (!(distance < k_far)) return {};
    thread_local std::vector<double> columns;
    columns.resize(attenuation_.constituents.size());
    scene_.field->column(seen.origin, seen.at(distance), columns);
    Spectrum arriving = attenuation_.transmittance(distance, columns);
    arriving *= scene_.water_surface->reflectance_from_water(
        glm::dot(seen.direction, scene_.water_surface->up()));
    return arriving;
}

}  // namespace uw
