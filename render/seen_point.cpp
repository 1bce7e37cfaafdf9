#include "render/seen_point.h"

#include <cmath>

namespace uw {

bool is_in_image(const ImagePoint& pixel, const Camera& camera) {
    return pixel.x >= 0 && pixel.y >= 0 && pixel.x <= camera.width() && pixel.y <= camera.height();
}

SeenPoint seen_point(const Point3& world, const Camera& camera, const Surfaces& surfaces) {
    if (std::isnan(world.x + world.y + world.z)) return {};
    const std::optional<ImagePoint> pixel = camera.project(world);
    if (!pixel) return {};
    const std::optional<Ray> ray = camera.refracted_ray(pixel->x, pixel->y);
    if (!ray) return {};
    SeenPoint seen{*pixel, distance(ray->origin, world), is_in_image(*pixel, camera)};
    seen.visible = seen.in_image && !surfaces.occluded(ray->origin, world);
    return seen;
}

}  // namespace uw
