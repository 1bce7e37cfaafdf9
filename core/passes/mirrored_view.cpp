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
            if (ray && surface.meet(*ray, k_far)) return true;
        }
    }
    return false;
}

std::optional<WaterSurface::Meeting> MirroredView::meeting(const Ray& ray) const {
    SurfaceHit hit;
    if (!scene_.surfaces->closest_hit(ray, k_far, hit) || !hit.is_water_surface)
        return std::nullopt;
    return WaterSurface::Meeting{hit.distance, -hit.geometric_normal};
}

std::optional<Ray> MirroredView::mirrored(const std::optional<Ray>& ray) const {
    if (!ray) return std::nullopt;
    const std::optional<WaterSurface::Meeting> meets = meeting(*ray);
    if (!meets) return std::nullopt;
    return scene_.water_surface->reflected(*ray, *meets);
}

bool MirroredView::add_arriving(double x, double y, Spectrum& sum) const {
    const std::optional<Ray> ray = rays_.refracted_ray(x, y);
    const std::optional<WaterSurface::Meeting> meets = ray ? meeting(*ray) : std::nullopt;
    if (!meets) return false;
    std::vector<double> columns(attenuation_.constituents.size());
    scene_.field->column(ray->origin, ray->at(meets->distance), columns);
    Spectrum arriving = attenuation_.transmittance(meets->distance, columns);
    arriving *=
        scene_.water_surface->reflectance_from_water(glm::dot(ray->direction, meets->normal));
    sum += arriving;
    return true;
}

// The pixel's centre stands for all of it, unless the surface has waves or something hides it
// there.
Spectrum MirroredView::arriving(int x, int y) const {
    const bool has_waves = scene_.water_surface->has_waves();
    const int places = has_waves ? 2 : 4;
    Spectrum sum{};
    if (!has_waves && add_arriving(x + 0.5, y + 0.5, sum)) return sum;
    int count = 0;
    for (int j = 0; j < places; ++j)
        for (int i = 0; i < places; ++i) {
            const bool meets = add_arriving(x + (i + 0.5) / places, y + (j + 0.5) / places, sum);
            if (!meets) continue;
            ++count;
            if (!has_waves) return sum;
        }
    if (count > 0) sum /= count;
    return sum;
}

}  // namespace uw
