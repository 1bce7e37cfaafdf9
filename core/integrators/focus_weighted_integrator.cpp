#include "core/integrators/focus_weighted_integrator.h"

#include <algorithm>
#include <utility>

#include "core/integrators/sensor.h"

namespace uw {

namespace {

// Number of slices from F to where the weight differs from 1 by less than 1e-3. Equal steps of
// sqrt(F / Z) are small near F, where the weight is steep, and large where it hardly changes.
constexpr int k_slices = 64;

}  // namespace

FocusWeightedIntegrator::FocusWeightedIntegrator(std::unique_ptr<const Integrator> integrator,
                                                 double focal_length)
    : integrator_(std::move(integrator)), focal_length_(focal_length) {
    for (int i = k_slices; i > 0; --i) {
        const double ratio = static_cast<double>(k_slices) / i;
        faces_.push_back(focal_length * ratio * ratio);
    }
}

void FocusWeightedIntegrator::in_scatter(const Ray& ray, std::span<const double> distances,
                                         InScatter& result) const {
    thread_local std::vector<double> stops;
    thread_local InScatter unweighted;
    find_stops(0, distances, stops);
    integrator_->in_scatter(ray, stops, unweighted);
    weigh(0, stops, unweighted, distances, result);
}

void FocusWeightedIntegrator::in_scatter_from(const Ray& ray, double begin,
                                              std::span<const double> distances,
                                              InScatter& result) const {
    thread_local std::vector<double> stops;
    thread_local InScatter unweighted;
    find_stops(begin, distances, stops);
    integrator_->in_scatter_from(ray, begin, stops, unweighted);
    weigh(begin, stops, unweighted, distances, result);
}

void FocusWeightedIntegrator::find_stops(double begin, std::span<const double> distances,
                                         std::vector<double>& stops) const {
    stops.assign(distances.begin(), distances.end());
    const auto first = std::upper_bound(faces_.begin(), faces_.end(), begin);
    const auto behind = std::lower_bound(first, faces_.end(), distances.back());
    stops.insert(stops.end(), first, behind);
    std::sort(stops.begin(), stops.end());
}

void FocusWeightedIntegrator::weigh(double begin, std::span<const double> stops,
                                    const InScatter& unweighted, std::span<const double> distances,
                                    InScatter& result) const {
    const std::size_t lamps = unweighted.lamp_count();
    result.reset(distances.size(), lamps);
    for (std::size_t j = 0; j < lamps; ++j) {
        Spectrum sum, before;
        std::size_t next = 0;  // of the distances
        for (std::size_t i = 0; i < stops.size(); ++i) {
            const double from = i == 0 ? begin : stops[i - 1];
            const double weight = focus_factor(0.5 * (from + stops[i]), focal_length_);
            sum += weight * (unweighted.at(i, j) - before);
            before = unweighted.at(i, j);
            for (; next < distances.size() && distances[next] <= stops[i]; ++next)
                result.at(next, j) = sum;
        }
    }
}

}  // namespace uw
