#include "core/multiple/interval_weights.h"

#include <algorithm>

#include "core/base/fast_exp.h"
#include "core/integrators/integrator.h"

namespace uw {

namespace {

// Of the concentrations along a ray.
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
    whole_.assign(intervals.count() * bands_, 0.0F);
    for (std::size_t i = 0; i < intervals.count(); ++i)
        add_uniform(intervals.begin(i), intervals.end(i), i, whole_);
}

void IntervalWeights::find(const Ray& ray, std::vector<float>& weights) const {
    thread_local ConcentrationProfile profile;
    if (vary()) {
        scene_.field->profile_within(tolerance_, ray, k_far, profile);
        if (profile.s.size() > 2 || !profile.empty_between(0)) {
            weights.assign(whole_.size(), 0.0F);
            add_profile(profile, weights);
            return;
        }
    }
    weights = whole_;
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

// Between knots and ends of intervals, with the mean scattering coefficient of each piece and a
// constant attenuation.
void IntervalWeights::add_profile(const ConcentrationProfile& profile,
                                  std::vector<float>& weights) const {
    const std::size_t count = per_unit_.size();
    thread_local std::vector<double> column, concentration;
    column.assign(count, 0.0);
    concentration.resize(count);
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
