#include "core/focus_weighted_integrator.h"

#include <algorithm>
#include <utility>

#include "core/sensor.h"

namespace uw {

namespace {

// Slices between F and where the weight is 1 to 1e-3. Equal steps of sqrt(F / Z) are fine near F,
// where the weight is steep, and coarse where it hardly changes.
constexpr int k_slices = 64;

}  // namespace

FocusWeightedIntegrator::FocusWeightedIntegrator(std::unique_ptr<Integrator> integrator,
                                                 double focal_length)
    : integrator_(std::move(integrator)), focal_length_(focal_length) {
    for (int i = k_slices; i > 0; --i) {
        const double ratio = static_cast<double>(k_slices) / i;
        faces_.push_back(focal_length * ratio * ratio);
    }
}

void FocusWeightedIntegrator::in_scatter(const Ray& ray, std::span<const double> ends,
                                         InScatter& result) const {
    thread_local std::vector<double> stops;  // the ends and the faces before the last of them
    thread_local InScatter unweighted;
    stops.assign(ends.begin(), ends.end());
    const auto behind = std::lower_bound(faces_.begin(), faces_.end(), ends.back());
    stops.insert(stops.end(), faces_.begin(), behind);
    std::sort(stops.begin(), stops.end());
    integrator_->in_scatter(ray, stops, unweighted);

    const std::size_t lamps = unweighted.lamp_count();
    result.reset(ends.size(), lamps);
    for (std::size_t j = 0; j < lamps; ++j) {
        Spectrum sum{};
        std::size_t end = 0;
        for (std::size_t i = 0; i < stops.size(); ++i) {
            const double begin = i == 0 ? 0.0 : stops[i - 1];
            const double weight = focus_factor(0.5 * (begin + stops[i]), focal_length_);
            for (std::size_t b = 0; b < k_max_bands; ++b) {
                const double before = i == 0 ? 0.0 : unweighted.at(i - 1, j)[b];
                sum[b] += weight * (unweighted.at(i, j)[b] - before);
            }
            for (; end < ends.size() && ends[end] <= stops[i]; ++end) result.at(end, j) = sum;
        }
    }
}

void FocusWeightedIntegrator::surface_light(const Ray& ray, const SurfaceHit& hit,
                                            SurfaceLight& light) const {
    integrator_->surface_light(ray, hit, light);
}

}  // namespace uw
