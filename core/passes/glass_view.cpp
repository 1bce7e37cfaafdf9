#include "core/passes/glass_view.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/geometry/water_surface.h"

namespace uw {

namespace {

/// A ray that is still to be followed.
struct Pending {
    GlassRay ray;
    Spectrum weight, clear;
    int depth = 0;
};

}  // namespace

GlassView::GlassView(const LitScene& scene)
    : scene_(scene),
      attenuation_(*scene.medium),
      bands_(static_cast<std::size_t>(scene.medium->band_count())) {}

void GlassView::follow(const Ray& ray, const SurfaceHit& hit, std::vector<GlassLeg>& legs) const {
    const GlassOptics& glass = *scene_.glass;
    std::vector<double> column(attenuation_.constituents.size());
    std::vector<Pending> pending;
    legs.clear();
    const auto left_of_water = [&](const Ray& along, double distance) {
        if (!column.empty()) scene_.field->column(along.origin, along.at(distance), column);
        return attenuation_.transmittance(distance, column);
    };
    const auto push = [&](const GlassRay& to, const Spectrum& fraction, const Spectrum& weight,
                          const Spectrum& clear, int depth) {
        Pending next{to, weight * fraction, clear * fraction, depth + 1};
        if (depth < k_max_depth && next.clear.greatest(bands_) > k_min_weight)
            pending.push_back(next);
    };
    const auto divide = [&](const GlassRay& along, const SurfaceHit& at, const Spectrum& weight,
                            const Spectrum& clear, int depth) {
        const GlassSplit split = glass.split(along, at);
        push(split.reflected, split.reflectance, weight, clear, depth);
        push(split.transmitted, split.transmittance, weight, clear, depth);
    };
    const Spectrum all = per_band(bands_, [](std::size_t) { return 1.0; });
    divide({ray, {}}, hit, left_of_water(ray, hit.distance), all, 0);
    while (!pending.empty()) {
        throw_if_stopped();
        const Pending from = pending.back();
        pending.pop_back();
        GlassLeg& leg = legs.emplace_back();
        leg.ray = from.ray.ray;
        leg.is_in_water = from.ray.around.glass() == 0;
        const double refracted = glass.radiance_in_water(from.ray.around);
        leg.weight = from.weight * refracted;
        leg.clear = from.clear * refracted;
        leg.has_hit = scene_.surfaces->closest_hit(leg.ray, k_far, leg.hit);
        if (!leg.has_hit) continue;
        leg.left = all;
        Spectrum clear = from.clear;
        if (leg.is_in_water) {
            leg.left = left_of_water(leg.ray, leg.hit.distance);
        } else {
            glass.absorb(from.ray.around, leg.hit.distance, leg.left);
            glass.absorb(from.ray.around, leg.hit.distance, clear);
        }
        const SurfaceHit& end = leg.hit;
        const Spectrum weight = from.weight * leg.left;
        if (end.glass != 0) {
            const SurfaceHit at = end;  // `legs` grows
            divide(from.ray, at, weight, clear, from.depth);
        } else if (end.is_water_surface && leg.is_in_water) {
            const WaterSurface& surface = *scene_.water_surface;
            const double reflectance =
                surface.reflectance_from_water(-glm::dot(leg.ray.direction, end.geometric_normal));
            push({surface.reflected(leg.ray, {end.distance, -end.geometric_normal}), {}},
                 per_band(bands_, [&](std::size_t) { return reflectance; }), weight, clear,
                 from.depth);
        }
    }
}

}  // namespace uw
