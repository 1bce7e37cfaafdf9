#include "core/paths/point_spread.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/numerics.h"

namespace uw {

namespace {

constexpr double k_max_angle = 1;  // of scattering that can form an image [rad]
// Optical depths of scattering between which surfaces fade out: beyond, their unscattered light is
// too faint to scale from.
constexpr double k_full_depth = 8, k_max_depth = 12;
constexpr int k_distances_of_interval = 2;  // nodes of the table per interval
// Below this frequency the transfer function is constant.
constexpr double k_min_frequency = 0.0875;  // [1/rad]
constexpr double k_frequency_step = 0.25;   // [octaves]

using Exponents = std::array<double, PointSpread::k_frequencies>;

/// The Hankel transform of a phase function, 2 pi int p(psi) J0(k psi) psi dpsi over small angles,
/// with p constant on each of many steps of the angle.
class PhaseTransfer {
  public:
    explicit PhaseTransfer(const PhaseFunction& phase) {
        constexpr int k_steps = 240;
        constexpr double k_min_angle = 1e-6;  // below it p is linear in psi^2
        const double growth = std::pow(k_max_angle / k_min_angle, 1.0 / k_steps);
        double begin = 0, end = k_min_angle;
        for (int step = 0; step <= k_steps; ++step) {
            // Where p is linear in psi^2, its mean over the solid angle is at half of psi^2.
            const double middle = step == 0 ? std::sqrt(0.5) * end : 0.5 * (begin + end);
            const double p = phase.eval(middle);
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
        const double place = std::log2(k / k_min_frequency) / k_frequency_step;
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
    return k_min_frequency * std::exp2(k_frequency_step * static_cast<double>(index));
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
                if (depth >= k_max_depth) continue;
                const double fade =
                    std::min(1.0, (k_max_depth - depth) / (k_max_depth - k_full_depth));
                for (std::size_t i = 0; i < k_frequencies; ++i) {
                    double exponent = 0;
                    for (std::size_t m = 0; m < phases.size(); ++m)
                        exponent += medium.uniform.scattering[m][b] * lengths[m][i];
                    transfer[i] =
                        static_cast<float>(fade * std::expm1(exponent) * std::exp(behind[b][i]));
                    behind[b][i] += exponent;
                }
            }
        }
    }
}

namespace {

int halved(int size) {
    return (size + 1) / 2;
}

// Reduces by the kernel 1/8 (1 3 3 1) around the centre of pixels 2 i and 2 i + 1, along x and then
// along y.
void reduce(const Grid2D<float>& fine, Grid2D<float>& rows, Grid2D<float>& coarse) {
    const int width = fine.width(), height = fine.height();
    rows.resize(halved(width), height);
    for (int y = 0; y < height; ++y) {
        const auto in = fine.row(y);
        const auto at = [&](int x) {
            return in[static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
        };
        const auto out = rows.row(y);
        const auto sum = [&](int i) {
            return 0.375F * (at(2 * i) + at(2 * i + 1)) + 0.125F * (at(2 * i - 1) + at(2 * i + 2));
        };
        const int inner = (width - 2) / 2;
        out[0] = sum(0);
        for (int i = 1; i < inner; ++i) {
            const float* pixel = &in[static_cast<std::size_t>(2 * i)];
            out[static_cast<std::size_t>(i)] =
                0.375F * (pixel[0] + pixel[1]) + 0.125F * (pixel[-1] + pixel[2]);
        }
        for (int i = std::max(1, inner); i < rows.width(); ++i)
            out[static_cast<std::size_t>(i)] = sum(i);
    }
    coarse.resize(rows.width(), halved(height));
    for (int j = 0; j < coarse.height(); ++j) {
        const auto row = [&](int y) { return rows.row(std::clamp(y, 0, height - 1)); };
        const auto before = row(2 * j - 1), first = row(2 * j), second = row(2 * j + 1),
                   after = row(2 * j + 2);
        const auto out = coarse.row(j);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = 0.375F * (first[i] + second[i]) + 0.125F * (before[i] + after[i]);
    }
}

// Smooths by the kernel 1/4 (1 2 1), whose transfer function is 0 at the Nyquist frequency, along x
// and then along y.
void smooth(Grid2D<float>& image, Grid2D<float>& rows) {
    const int width = image.width(), height = image.height();
    rows.resize(width, height);
    for (int y = 0; y < height; ++y) {
        const auto in = image.row(y), out = rows.row(y);
        const std::size_t last = in.size() - 1;
        for (std::size_t i = 0; i <= last; ++i)
            out[i] = 0.5F * in[i] + 0.25F * (in[i > 0 ? i - 1 : 0] + in[std::min(i + 1, last)]);
    }
    for (int y = 0; y < height; ++y) {
        const auto before = rows.row(std::max(y - 1, 0)), middle = rows.row(y),
                   after = rows.row(std::min(y + 1, height - 1)), out = image.row(y);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = 0.5F * middle[i] + 0.25F * (before[i] + after[i]);
    }
}

// Expands by linear interpolation, along y and then along x.
void add_expanded(const Grid2D<float>& coarse, Grid2D<float>& rows, Grid2D<float>& fine) {
    const int height = fine.height();
    rows.resize(coarse.width(), 1);
    const auto row = rows.row(0);
    for (int y = 0; y < height; ++y) {
        const auto near = coarse.row(y / 2);
        const auto far =
            coarse.row(std::clamp(y / 2 + (y % 2 == 0 ? -1 : 1), 0, coarse.height() - 1));
        for (std::size_t i = 0; i < row.size(); ++i) row[i] = 0.75F * near[i] + 0.25F * far[i];
        const auto out = fine.row(y);
        const std::size_t last = row.size() - 1;
        for (std::size_t i = 0; i <= last; ++i) {
            const float before = row[i > 0 ? i - 1 : 0], after = row[std::min(i + 1, last)];
            out[2 * i] += 0.75F * row[i] + 0.25F * before;
            if (2 * i + 1 < out.size()) out[2 * i + 1] += 0.75F * row[i] + 0.25F * after;
        }
    }
}

}  // namespace

// Each reduction and each expansion adds 1/4 squared pixel of the finer image and 1/2 of its own to
// the variance; smoothing adds 1/2 squared pixel of the level.
double BlurPyramid::deviation(int level) {
    return level == 0 ? 0 : std::sqrt(std::exp2(2 * (level - 1)) - 0.5);
}

// Each reduction and each expansion has the transfer function cos(w / 2)^3 at its own w, which
// doubles from step to step, and smoothing cos(w / 2)^2. Their product follows from
//     cos x cos 2x … cos 2^(n-1) x = sin(2^n x) / (2^n sin x).
double BlurPyramid::transfer(int level, double omega) {
    if (level == 0) return 1;
    const double x = 0.5 * omega, wide = std::exp2(level - 1), sine = wide * std::sin(x);
    const double steps = sine == 0 ? 1 : std::sin(wide * x) / sine;
    const double smoothing = std::cos(wide * x);
    return std::pow(steps, 6) * smoothing * smoothing;
}

int BlurPyramid::level_count(int width, int height) {
    return 2 + std::bit_width(static_cast<unsigned>(std::max(1, std::max(width, height)) - 1));
}

void BlurPyramid::begin(int width, int height) {
    unblurred_.assign(width, height);
    levels_.resize(static_cast<std::size_t>(level_count(width, height)) - 1);
    for (Grid2D<float>& level : levels_) {
        level.assign(width, height);
        width = halved(width);
        height = halved(height);
    }
}

void BlurPyramid::add(int level, Grid2D<float>& image) {
    for (int l = 1; l < level; ++l) {
        reduce(image, rows_, coarse_);
        std::swap(image, coarse_);
    }
    if (level > 0) smooth(image, rows_);
    Grid2D<float>& sum = level == 0 ? unblurred_ : levels_[static_cast<std::size_t>(level) - 1];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += image[i];
}

const Grid2D<float>& BlurPyramid::sum() {
    for (std::size_t l = levels_.size(); --l > 0;) add_expanded(levels_[l], rows_, levels_[l - 1]);
    for (std::size_t i = 0; i < unblurred_.size(); ++i) unblurred_[i] += levels_.front()[i];
    return unblurred_;
}

namespace {

// Tikhonov regularisation, against large weights that cancel one another.
constexpr double k_ridge = 1e-4;

// The transfer function of a mean over pixels that is taken twice.
double transfer_of_pixels(double omega) {
    const double sinc = std::sin(0.5 * omega) / (0.5 * omega);
    return sinc * sinc;
}

}  // namespace

BlurFit::BlurFit(int levels, double pixel) : levels_(static_cast<std::size_t>(levels)) {
    while (frequencies_ < PointSpread::k_frequencies &&
           PointSpread::frequency(frequencies_) * pixel <= std::numbers::pi) {
        const double omega = PointSpread::frequency(frequencies_) * pixel;
        pixel_transfers_.push_back(transfer_of_pixels(omega));
        const double alias = 2 * std::numbers::pi - omega;
        // The table may end before the frequencies of very fine images do: its last entry is used.
        std::size_t index = std::min(frequencies_, PointSpread::k_frequencies - 2);
        while (index + 2 < PointSpread::k_frequencies &&
               PointSpread::frequency(index + 1) * pixel < alias)
            ++index;
        const double begin = PointSpread::frequency(index) * pixel;
        const double end = PointSpread::frequency(index + 1) * pixel;
        const double t = std::clamp((alias - begin) / (end - begin), 0.0, 1.0);
        const double pixel_transfer = transfer_of_pixels(alias);
        aliases_.push_back({index, pixel_transfer * (1 - t), pixel_transfer * t});
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
    // This bound holds, as the ridge alone leaves greater pivots.
    normal_.factor(normal, levels_, 0.1 * k_ridge / PointSpread::k_frequencies);
}

void BlurFit::fit(const PointSpread::Transfer& transfer, std::span<double> weights) const {
    std::ranges::fill(weights, 0.0);
    for (std::size_t i = 0; i < frequencies_; ++i) {
        const Alias& alias = aliases_[i];
        const double visible = pixel_transfers_[i] * static_cast<double>(transfer[i]) +
                               alias.below * static_cast<double>(transfer[alias.index]) +
                               alias.above * static_cast<double>(transfer[alias.index + 1]);
        for (std::size_t l = 0; l < levels_; ++l)
            weights[l] += responses_[l * frequencies_ + i] * visible;
    }
    normal_.solve(weights);
}

}  // namespace uw
