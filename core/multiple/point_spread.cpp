#include "core/multiple/point_spread.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/quadrature.h"

namespace uw {

namespace {

constexpr double k_widest_scattering = 1;  // that can form an image [rad]
// Optical depths of scattering between which surfaces are left out, little by little: their own
// light is too faint to tell what there is of it.
constexpr double k_full_depth = 8, k_most_depth = 12;
constexpr int k_distances_of_interval = 2;  // in the table
// Below the least frequency all is even.
constexpr double k_least_frequency = 0.0875;  // [1/rad]
constexpr double k_frequency_step = 0.25;     // [octaves]

using Exponents = std::array<double, PointSpread::k_frequencies>;

/// The Hankel transform of a phase function, 2 pi int p(psi) J0(k psi) psi dpsi over small angles,
/// from that of functions which are constant on steps of the angle.
class PhaseTransfer {
  public:
    explicit PhaseTransfer(const PhaseFunction& phase) {
        constexpr int k_steps = 200;
        constexpr double k_narrowest = 1e-5;
        const double growth = std::pow(k_widest_scattering / k_narrowest, 1.0 / k_steps);
        double begin = 0, end = k_narrowest;
        for (int step = 0; step <= k_steps; ++step) {
            const double p = phase.evaluate(0.5 * (begin + end));
            for (std::size_t i = 0; i < values_.size(); ++i) {
                const double k = PointSpread::frequency(i);
                values_[i] += 2 * std::numbers::pi * p / k *
                              (end * std::cyl_bessel_j(1.0, k * end) -
                               begin * std::cyl_bessel_j(1.0, k * begin));
            }
            begin = end;
            end *= growth;
        }
    }

    double at(double k) const {
        const double place = std::log2(k / k_least_frequency) / k_frequency_step;
        if (!(place > 0)) return values_.front();
        const auto i = std::min(static_cast<std::size_t>(place), values_.size() - 2);
        const double t = std::min(1.0, place - static_cast<double>(i));
        return values_[i] + t * (values_[i + 1] - values_[i]);
    }

  private:
    Exponents values_{};
};

}  // namespace

double PointSpread::frequency(std::size_t index) {
    return k_least_frequency * std::exp2(k_frequency_step * static_cast<double>(index));
}

PointSpread::PointSpread(const Medium& medium, const DistanceIntervals& intervals, double farthest)
    : bands_(static_cast<std::size_t>(medium.band_count())) {
    while (intervals_ < intervals.count() && intervals.begin(intervals_) < farthest) ++intervals_;
    for (std::size_t i = 0; i < intervals_; ++i) {
        const double begin = intervals.begin(i), end = std::min(farthest, intervals.end(i));
        for (int step = 0; step < k_distances_of_interval; ++step)
            distances_.push_back(begin + (end - begin) * step / k_distances_of_interval);
    }
    distances_.push_back(farthest);
    transfers_.resize(intervals_ * bands_ * distances_.size());
    std::vector<PhaseTransfer> phases;
    for (const auto& phase : medium.phase_functions) phases.emplace_back(*phase);

    // By phase function: int p^(k (T - s) / T) ds over an interval.
    std::vector<Exponents> lengths(phases.size());
    for (std::size_t d = 1; d < distances_.size(); ++d) {
        const double distance = distances_[d];
        std::vector<Exponents> behind(bands_);  // the exponents of the intervals behind
        for (std::size_t interval = intervals_; interval-- > 0;) {
            const double begin = intervals.begin(interval);
            const double length = std::min(distance, intervals.end(interval)) - begin;
            if (length <= 0) continue;
            for (std::size_t m = 0; m < phases.size(); ++m) {
                lengths[m] = {};
                for (const auto& [position, weight] : gauss_legendre(4)) {
                    const double scale = 1 - (begin + position * length) / distance;
                    for (std::size_t i = 0; i < k_frequencies; ++i)
                        lengths[m][i] += weight * length * phases[m].at(scale * frequency(i));
                }
            }
            for (std::size_t b = 0; b < bands_; ++b) {
                Transfer& transfer = transfers_[(interval * bands_ + b) * distances_.size() + d];
                const double depth = medium.uniform.total_scattering()[b] * distance;
                if (depth >= k_most_depth) continue;
                const double share =
                    std::min(1.0, (k_most_depth - depth) / (k_most_depth - k_full_depth));
                for (std::size_t i = 0; i < k_frequencies; ++i) {
                    double exponent = 0;
                    for (std::size_t m = 0; m < phases.size(); ++m)
                        exponent += medium.uniform.scattering[m][b] * lengths[m][i];
                    transfer[i] =
                        static_cast<float>(share * std::expm1(exponent) * std::exp(behind[b][i]));
                    behind[b][i] += exponent;
                }
            }
        }
    }
}

}  // namespace uw
