#include "core/frame/point_spread.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/quadrature.h"

namespace uw {

namespace {

constexpr double k_widest = 0.35;          // component [rad]
constexpr double k_widest_scattering = 1;  // that can form an image [rad]
// Optical depths of scattering between which surfaces are left out, little by little: their own
// light is too faint to tell what there is of it.
constexpr double k_full_depth = 8, k_most_depth = 12;
constexpr int k_distances_of_interval = 2;  // in the table
// Angular frequencies at which transfer functions are fitted: 4 to an octave, from those on that
// are far below the widest component's.
constexpr std::size_t k_frequencies = 64;
constexpr double k_least_frequency = 0.125 / k_widest;
constexpr double k_frequency_step = 0.25;  // [octaves]
// Against weights that grow by cancelling one another.
constexpr double k_ridge = 1e-4;

using Transfer = std::array<double, k_frequencies>;

double frequency(std::size_t i) {
    return k_least_frequency * std::exp2(k_frequency_step * static_cast<double>(i));
}

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
            for (std::size_t i = 0; i < k_frequencies; ++i) {
                const double k = frequency(i);
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
        const auto i = std::min(static_cast<std::size_t>(place), k_frequencies - 2);
        const double t = std::min(1.0, place - static_cast<double>(i));
        return values_[i] + t * (values_[i + 1] - values_[i]);
    }

  private:
    Transfer values_{};
};

/// Least squares for the weights of the components of a transfer function.
class GaussianFit {
  public:
    GaussianFit() {
        for (std::size_t i = 0; i < k_frequencies; ++i)
            for (std::size_t m = 0; m < k_count; ++m) {
                const double x = frequency(i) * PointSpread::deviation(m);
                basis_[m][i] = std::exp(-0.5 * x * x);
            }
        // Cholesky's factor of the normal equations.
        for (std::size_t i = 0; i < k_count; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = i == j ? k_ridge : 0;
                for (std::size_t f = 0; f < k_frequencies; ++f) sum += basis_[i][f] * basis_[j][f];
                for (std::size_t k = 0; k < j; ++k) sum -= factor_[i][k] * factor_[j][k];
                factor_[i][j] = i == j ? std::sqrt(sum) : sum / factor_[j][j];
            }
        }
    }

    PointSpread::Weights fit(const Transfer& transfer) const {
        std::array<double, k_count> x{};
        for (std::size_t i = 0; i < k_count; ++i) {
            for (std::size_t f = 0; f < k_frequencies; ++f) x[i] += basis_[i][f] * transfer[f];
            for (std::size_t k = 0; k < i; ++k) x[i] -= factor_[i][k] * x[k];
            x[i] /= factor_[i][i];
        }
        for (std::size_t i = k_count; i-- > 0;) {
            for (std::size_t k = i + 1; k < k_count; ++k) x[i] -= factor_[k][i] * x[k];
            x[i] /= factor_[i][i];
        }
        PointSpread::Weights weights{};
        std::ranges::transform(x, weights.begin(), [](double w) { return static_cast<float>(w); });
        return weights;
    }

  private:
    static constexpr std::size_t k_count = PointSpread::k_components;
    std::array<Transfer, k_count> basis_{};
    std::array<std::array<double, k_count>, k_count> factor_{};
};

}  // namespace

double PointSpread::deviation(std::size_t component) {
    return k_widest * std::exp2(-static_cast<double>(component));
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
    weights_.resize(intervals_ * bands_ * distances_.size());
    const GaussianFit gaussians;
    std::vector<PhaseTransfer> phases;
    for (const auto& phase : medium.phase_functions) phases.emplace_back(*phase);

    // By phase function: int p^(k (T - s) / T) ds over an interval.
    std::vector<Transfer> lengths(phases.size());
    for (std::size_t d = 1; d < distances_.size(); ++d) {
        const double distance = distances_[d];
        std::vector<Transfer> behind(bands_);  // the exponents of the intervals behind
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
                Transfer transfer{};
                const double depth = medium.uniform.total_scattering()[b] * distance;
                if (depth >= k_most_depth) continue;
                const double share =
                    std::min(1.0, (k_most_depth - depth) / (k_most_depth - k_full_depth));
                for (std::size_t i = 0; i < k_frequencies; ++i) {
                    double exponent = 0;
                    for (std::size_t m = 0; m < phases.size(); ++m)
                        exponent += medium.uniform.scattering[m][b] * lengths[m][i];
                    transfer[i] = share * std::expm1(exponent) * std::exp(behind[b][i]);
                    behind[b][i] += exponent;
                }
                weights_[(interval * bands_ + b) * distances_.size() + d] = gaussians.fit(transfer);
            }
        }
    }
}

}  // namespace uw
