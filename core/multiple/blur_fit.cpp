#include "core/multiple/blur_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/multiple/blur_pyramid.h"

namespace uw {

namespace {

// Against weights that grow by cancelling one another.
constexpr double k_ridge = 1e-4;

// Of a mean over pixels, twice.
double transfer_of_pixels(double omega) {
    const double sinc = std::sin(0.5 * omega) / (0.5 * omega);
    return sinc * sinc;
}

}  // namespace

BlurFit::BlurFit(int levels, double pixel) : levels_(static_cast<std::size_t>(levels)) {
    while (frequencies_ < PointSpread::k_frequencies &&
           PointSpread::frequency(frequencies_) * pixel <= std::numbers::pi) {
        const double omega = PointSpread::frequency(frequencies_) * pixel;
        shares_.push_back(transfer_of_pixels(omega));
        const double alias = 2 * std::numbers::pi - omega;
        // Of images so fine that the table ends before their own frequencies do: its last one.
        std::size_t index = std::min(frequencies_, PointSpread::k_frequencies - 2);
        while (index + 2 < PointSpread::k_frequencies &&
               PointSpread::frequency(index + 1) * pixel < alias)
            ++index;
        const double begin = PointSpread::frequency(index) * pixel;
        const double end = PointSpread::frequency(index + 1) * pixel;
        const double t = std::clamp((alias - begin) / (end - begin), 0.0, 1.0);
        const double share = transfer_of_pixels(alias);
        aliases_.push_back({index, share * (1 - t), share * t});
        ++frequencies_;
    }
    for (int level = 0; level < levels; ++level)
        for (std::size_t i = 0; i < frequencies_; ++i)
            responses_.push_back(BlurPyramid::transfer(level, PointSpread::frequency(i) * pixel));
    std::vector<double> normal(levels_ * levels_);
    for (std::size_t l = 0; l < levels_; ++l) {
        for (std::size_t m = 0; m <= l; ++m) {
            double sum = l == m ? k_ridge : 0;
            for (std::size_t i = 0; i < frequencies_; ++i)
                sum += responses_[l * frequencies_ + i] * responses_[m * frequencies_ + i];
            normal[l * levels_ + m] = sum;
        }
    }
    // The ridge alone leaves pivots above this.
    normal_.factor(normal, levels_, 0.1 * k_ridge / PointSpread::k_frequencies);
}

void BlurFit::fit(const PointSpread::Transfer& transfer, std::span<double> weights) const {
    std::ranges::fill(weights, 0.0);
    for (std::size_t i = 0; i < frequencies_; ++i) {
        const Alias& alias = aliases_[i];
        const double shown = shares_[i] * static_cast<double>(transfer[i]) +
                             alias.below * static_cast<double>(transfer[alias.index]) +
                             alias.above * static_cast<double>(transfer[alias.index + 1]);
        for (std::size_t l = 0; l < levels_; ++l)
            weights[l] += responses_[l * frequencies_ + i] * shown;
    }
    normal_.solve(weights);
}

}  // namespace uw
