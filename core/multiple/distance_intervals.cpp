#include "core/multiple/distance_intervals.h"

#include <algorithm>
#include <cmath>

#include "core/base/fast_exp.h"
#include "core/integrators/integrator.h"

namespace uw {

namespace {

constexpr int k_intervals = 20;   // up to the farthest surface
constexpr double k_growth = 1.5;  // of those beyond
// Optical depth beyond which nothing is seen, and that up to which open water has fine intervals.
constexpr double k_reach_depth = 15, k_fine_depth = 3;
constexpr int k_rays_across = 16;  // of a coarse lattice that finds how far surfaces are

struct Extent {
    double far = 0;        // distance of the farthest surface [m]
    bool is_open = false;  // some rays hit none
};

Extent find_extent(const RaySource& rays, const Surfaces& surfaces) {
    Extent extent;
    for (int j = 0; j < k_rays_across; ++j) {
        for (int i = 0; i < k_rays_across; ++i) {
            const auto ray = rays.refracted_ray((i + 0.5) * rays.width() / k_rays_across,
                                                (j + 0.5) * rays.height() / k_rays_across);
            if (!ray) continue;
            const double distance = surfaces.hit_distance(*ray);
            if (distance < k_far)
                extent.far = std::max(extent.far, distance);
            else
                extent.is_open = true;
        }
    }
    if (extent.far == 0) extent.is_open = true;
    return extent;
}

// Open water matters as far as the lamps are away, and to some optical depth.
double fine_reach_of_open_water(const RaySource& rays, const LitScene& scene, double c) {
    double reach = c > 0 ? k_fine_depth / c : 0;
    const auto ray = rays.refracted_ray(0.5 * rays.width(), 0.5 * rays.height());
    if (!ray) return reach;
    for (const Lamp& lamp : *scene.emitters)
        reach = std::max(reach, 2 * distance(ray->origin, lamp.origin(ray->origin)));
    return reach;
}

}  // namespace

DistanceIntervals::DistanceIntervals(const RaySource& rays, const LitScene& scene)
    : attenuation_(*scene.medium) {
    const double c = attenuation_.uniform.least(static_cast<std::size_t>(attenuation_.band_count));
    const double reach = c > 0 ? std::min(k_far, k_reach_depth / c) : k_far;
    const Extent extent = find_extent(rays, *scene.surfaces);
    double fine = extent.far;
    if (extent.is_open) fine = std::max(fine, fine_reach_of_open_water(rays, scene, c));
    if (!(fine > 0)) fine = reach;
    fine = std::min(fine, reach);
    // Closer together near the camera.
    for (int i = 0; i <= k_intervals; ++i)
        ends_.push_back(fine * std::pow(static_cast<double>(i) / k_intervals, 1.5));
    while (ends_.back() < reach) ends_.push_back(std::min(reach, k_growth * ends_.back()));
    ends_.back() = std::max(ends_.back(), k_far);
}

std::size_t DistanceIntervals::at(double distance) const {
    const auto end = std::lower_bound(ends_.begin() + 1, ends_.end() - 1, distance);
    return static_cast<std::size_t>(end - ends_.begin()) - 1;
}

double DistanceIntervals::share(std::size_t interval, std::size_t band, double distance) const {
    const double from = begin(interval), to = end(interval);
    if (distance >= to) return 1;
    if (distance <= from) return 0;
    const double c = attenuation_.uniform[band];
    if (c * (to - from) < 1e-4) return (distance - from) / (to - from);
    return (1 - exp_of_minus(c * (distance - from))) / (1 - exp_of_minus(c * (to - from)));
}

}  // namespace uw
