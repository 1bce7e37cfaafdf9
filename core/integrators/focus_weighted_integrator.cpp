#include "core/integrators/focus_weighted_integrator.h"

#include <algorithm>
#include <utility>

#include "core/integrators/sensor.h"

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
    thread_local std::vector<double> stops;
    thread_local InScatter unweighted;
    find_stops(0, ends, stops);
    integrator_->in_scatter(ray, stops, unweighted);
    weigh(0, stops, unweighted, ends, result);
}

void FocusWeightedIntegrator::in_scatter_from(const Ray& ray, double begin,
                                              std::span<const double> ends,
                                              InScatter& result) const {
    thread_local std::vector<double> stops;
    thread_local InScatter unweighted;
    find_stops(begin, ends, stops);
    integrator_->in_scatter_from(ray, begin, stops, unweighted);
    weigh(begin, stops, unweighted, ends, result);
}

void FocusWeightedIntegrator::find_stops(double begin, std::span<const double> ends,
                                         std::vector<double>& stops) const {
    stops.assign(ends.begin(), ends.end());
    const auto first = std::upper_bound(faces_.begin(), faces_.end(), begin);
    const auto behind = std::lower_bound(first, faces_.end(), ends.back());
    stops.insert(stops.end(), first, behind);
    std::sort(stops.begin(), stops.end());
}

void FocusWeightedIntegrator::weigh(double begin, std::span<const double> stops,
                                    const InScatter& unweighted, std::span<const double> ends,
                                    InScatter& result) const {
    const std::size_t lamps = unweighted.lamp_count();
    result.reset(ends.size(), lamps);
    for (std::size_t j = 0; j < lamps; ++j) {
        Spectrum sum{};
        std::size_t end = 0;
        for (std::size_t i = 0; i < stops.size(); ++i) {
            const double from = i == 0 ? begin : stops[i - 1];
            const double weight = focus_factor(0.5 * (from + stops[i]), focal_length_);
            for (std::size_t b = 0; b < k_max_bands; ++b) {
                const double before = i == 0 ? 0.0 : unweighted.at(i - 1, j)[b];
                sum[b] += weight * (unweighted.at(i, j)[b] - before);
            }
            for (; end < ends.size() && ends[end] <= stops[i]; ++end) result.at(end, j) = sum;
        }
    }
}

void FocusWeightedIntegrator::surface_lights(std::span<const SurfaceSample* const> samples,
                                             SurfaceLight& light) const {
    integrator_->surface_lights(samples, light);
}

}  // namespace uw
