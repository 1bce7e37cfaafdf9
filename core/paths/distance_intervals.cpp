#include "core/paths/distance_intervals.h"

#include <algorithm>
#include <cmath>

#include "core/base/numerics.h"
#include "core/light/integrator.h"

namespace uw {

namespace {

constexpr int k_intervals = 20;   // up to the farthest surface
constexpr double k_growth = 1.5;  // ratio of the ends of the intervals beyond
// Optical depth beyond which nothing is visible, and that up to which open water has fine
// intervals.
constexpr double k_dark_depth = 15, k_fine_depth = 3;
constexpr int k_rays_across = 16;  // of a lattice of rays that measures the distances of surfaces

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

// Open water has fine intervals up to the optical depth k_fine_depth, and at least to twice the
// distance of the farthest lamp.
double fine_distance_in_open_water(const RaySource& rays, const LitScene& scene, double c) {
    double max_distance = c > 0 ? k_fine_depth / c : 0;
    const auto ray = rays.refracted_ray(0.5 * rays.width(), 0.5 * rays.height());
    if (!ray) return max_distance;
    for (const Lamp& lamp : *scene.emitters)
        max_distance = std::max(max_distance, 2 * distance(ray->origin, lamp.origin(ray->origin)));
    return max_distance;
}

}  // namespace

DistanceIntervals::DistanceIntervals(const RaySource& rays, const LitScene& scene)
    : attenuation_(*scene.medium) {
    const double c = attenuation_.uniform.least(static_cast<std::size_t>(attenuation_.band_count));
    const double max_distance = c > 0 ? std::min(k_far, k_dark_depth / c) : k_far;
    const Extent extent = find_extent(rays, *scene.surfaces);
    double fine = extent.far;
    if (extent.is_open) fine = std::max(fine, fine_distance_in_open_water(rays, scene, c));
    if (!(fine > 0)) fine = max_distance;
    fine = std::min(fine, max_distance);
    // The intervals are closer together near the camera.
    for (int i = 0; i <= k_intervals; ++i)
        ends_.push_back(fine * std::pow(static_cast<double>(i) / k_intervals, 1.5));
    while (ends_.back() < max_distance)
        ends_.push_back(std::min(max_distance, k_growth * ends_.back()));
    ends_.back() = std::max(ends_.back(), k_far);
}

std::size_t DistanceIntervals::at(double distance) const {
    const auto end = std::lower_bound(ends_.begin() + 1, ends_.end() - 1, distance);
    return static_cast<std::size_t>(end - ends_.begin()) - 1;
}

double DistanceIntervals::fraction_before(std::size_t interval, std::size_t band,
                                          double distance) const {
    const double from = begin(interval), to = end(interval);
    if (distance >= to) return 1;
    if (distance <= from) return 0;
    const double c = attenuation_.uniform[band];
    if (c * (to - from) < 1e-4) return (distance - from) / (to - from);
    return (1 - exp_of_minus(c * (distance - from))) / (1 - exp_of_minus(c * (to - from)));
}

namespace {

// The error with which profiles along a ray may approximate optical depths.
constexpr double k_depth_tolerance = 5e-3;

// int_0^1 e^-(t x) dt, where e^-x is `transmittance`.
double mean_transmittance(double x, double transmittance) {
    return x > 1e-4 ? (1 - transmittance) / x : 1 - 0.5 * x;
}

}  // namespace

IntervalWeights::IntervalWeights(const LitScene& scene, const DistanceIntervals& intervals)
    : scene_(scene),
      intervals_(intervals),
      attenuation_(*scene.medium),
      tolerance_(*scene.medium, k_depth_tolerance),
      bands_(static_cast<std::size_t>(scene.medium->band_count())),
      scattering_(scene.medium->uniform.total_scattering()) {
    for (const Constituent& constituent : scene.medium->constituents)
        per_unit_.push_back(constituent.per_unit.total_scattering());
    uniform_weights_.assign(intervals.count() * bands_, 0.0F);
    for (std::size_t i = 0; i < intervals.count(); ++i)
        add_uniform(intervals.begin(i), intervals.end(i), i, uniform_weights_);
}

void IntervalWeights::find(const Ray& ray, std::vector<float>& weights) const {
    if (vary()) {
        ConcentrationProfile profile;
        scene_.field->profile_within(tolerance_, ray, k_far, profile);
        if (profile.s.size() > 2 || !profile.empty_between(0)) {
            weights.assign(uniform_weights_.size(), 0.0F);
            add_profile(profile, weights);
            return;
        }
    }
    weights = uniform_weights_;
}

void IntervalWeights::add_uniform(double begin, double end, std::size_t interval,
                                  std::vector<float>& weights) const {
    for (std::size_t b = 0; b < bands_; ++b) {
        const double c = attenuation_.uniform[b], depth = c * (end - begin);
        const double light = exp_of_minus(c * begin) * (end - begin) *
                             mean_transmittance(depth, exp_of_minus(depth));
        weights[interval * bands_ + b] += static_cast<float>(scattering_[b] * light);
    }
}

// Integrates between the knots of the profile and the ends of the intervals. The scattering and
// attenuation coefficients of each piece are its means.
void IntervalWeights::add_profile(const ConcentrationProfile& profile,
                                  std::vector<float>& weights) const {
    const std::size_t count = per_unit_.size();
    std::vector<double> column(count, 0.0), concentration(count);
    Spectrum depth{}, transmittance{};
    for (std::size_t b = 0; b < bands_; ++b) transmittance[b] = 1;
    double s = 0;
    std::size_t interval = 0;
    for (std::size_t knot = 0; knot + 1 < profile.s.size(); ++knot) {
        const double begin = profile.s[knot], length = profile.s[knot + 1] - begin;
        while (s < profile.s[knot + 1]) {
            const double end = std::min(profile.s[knot + 1], intervals_.end(interval));
            const double from = (s - begin) / length, to = (end - begin) / length;
            for (std::size_t k = 0; k < count; ++k) {
                const double first = profile.concentration[knot * count + k];
                const double rise = profile.concentration[(knot + 1) * count + k] - first;
                concentration[k] = first + 0.5 * (from + to) * rise;
                column[k] += (end - s) * concentration[k];
            }
            for (std::size_t b = 0; b < bands_; ++b) {
                double scattering = scattering_[b];
                for (std::size_t k = 0; k < count; ++k)
                    scattering += concentration[k] * per_unit_[k][b];
                const double next = attenuation_.optical_depth(b, end, column);
                const double here = exp_of_minus(next - depth[b]);
                weights[interval * bands_ + b] +=
                    static_cast<float>(scattering * (end - s) * transmittance[b] *
                                       mean_transmittance(next - depth[b], here));
                transmittance[b] *= here;
                depth[b] = next;
            }
            s = end;
            if (s >= intervals_.end(interval) && interval + 1 < intervals_.count()) ++interval;
        }
    }
}

}  // namespace uw
