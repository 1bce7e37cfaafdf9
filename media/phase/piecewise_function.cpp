#include "media/phase/piecewise_function.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace uw {

namespace {

/// Gauss-Legendre rule of 8 nodes on [-1, 1], the positive half (Abramowitz and Stegun 25.4.30).
constexpr std::array<double, 4> k_gauss_node{0.1834346424956498, 0.5255324099163290,
                                             0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> k_gauss_weight{0.3626837833783620, 0.3137066458778873,
                                               0.2223810344533745, 0.1012285362903763};

/// int_a^b f(x) dx over panels narrow enough for the rule to be exact to rounding for e^(rate x).
template <class F>
double integrate(const F& f, double a, double b, double rate) {
    const double span = b - a;
    const auto panels = static_cast<int>(std::ceil(2 * span * std::max(1.0, std::abs(rate))));
    const double half = 0.5 * span / panels;
    double sum = 0;
    for (int i = 0; i < panels; ++i) {
        const double middle = a + (2 * i + 1) * half;
        for (std::size_t k = 0; k < k_gauss_node.size(); ++k) {
            const double offset = k_gauss_node[k] * half;
            sum += k_gauss_weight[k] * (f(middle - offset) + f(middle + offset));
        }
    }
    return sum * half;
}

/// Bucket of a positive angle: its exponent and the first five bits of its mantissa.
std::uint64_t key_of(double psi) {
    return std::bit_cast<std::uint64_t>(psi) >> 47;
}

}  // namespace

PiecewiseFunction::PiecewiseFunction(std::vector<double> psi, const std::vector<double>& value,
                                     const std::vector<Law>& laws)
    : psi_(std::move(psi)) {
    for (std::size_t i = 0; i < laws.size(); ++i) {
        const bool log_value = laws[i] != Law::linear;
        const bool log_angle = laws[i] == Law::power;
        const double x0 = log_angle ? std::log(psi_[i]) : psi_[i];
        const double x1 = log_angle ? std::log(psi_[i + 1]) : psi_[i + 1];
        const double y0 = log_value ? std::log(value[i]) : value[i];
        const double y1 = log_value ? std::log(value[i + 1]) : value[i + 1];
        const double m = (y1 - y0) / (x1 - x0);
        segments_.push_back({laws[i], x0, y0, m});
    }
    first_key_ = key_of(psi_[1]);
    const std::uint64_t last_key = key_of(psi_.back());
    std::uint32_t segment = 0;
    for (std::uint64_t key = first_key_; key <= last_key; ++key) {
        const auto lower_edge = std::bit_cast<double>(key << 47);
        while (segment + 1 < segments_.size() && psi_[segment + 1] <= lower_edge) ++segment;
        bucket_.push_back(segment);
    }
}

std::size_t PiecewiseFunction::segment_of(double psi) const {
    if (psi < psi_[1]) return 0;
    const std::size_t bucket = key_of(psi) - first_key_;
    const std::size_t lowest = bucket_[bucket];
    const std::size_t highest =
        bucket + 1 < bucket_.size() ? bucket_[bucket + 1] : segments_.size() - 1;
    // Knots inside the bucket: at most one, except in very dense tables.
    const auto begin = psi_.begin() + static_cast<std::ptrdiff_t>(lowest) + 1;
    const auto end = psi_.begin() + static_cast<std::ptrdiff_t>(highest) + 1;
    return lowest + static_cast<std::size_t>(std::upper_bound(begin, end, psi) - begin);
}

double PiecewiseFunction::evaluate(const Segment& segment, double psi) {
    switch (segment.law) {
        case Law::exponential:
            return std::exp(segment.y + segment.m * (psi - segment.x));
        case Law::power:
            return std::exp(segment.y + segment.m * (std::log(psi) - segment.x));
        case Law::linear:
            break;
    }
    return std::max(
        0.0,
        segment.y + segment.m * (psi - segment.x));  // rounding may fall below an end of 0
}

double PiecewiseFunction::evaluate(double psi) const {
    const double inside = std::clamp(psi, 0.0, psi_.back());
    return evaluate(segments_[segment_of(inside)], inside);
}

double PiecewiseFunction::integral(std::size_t first_knot, std::size_t last_knot) const {
    double sum = 0;
    for (std::size_t i = first_knot; i < last_knot; ++i) {
        const Segment& segment = segments_[i];
        const auto weighted = [&](double angle) {
            return evaluate(segment, angle) * std::sin(angle);
        };
        if (segment.law == Law::power)  // smooth in u = ln psi, where it is e^((m + 2) u)
            sum += integrate([&](double u) { return weighted(std::exp(u)) * std::exp(u); },
                             std::log(psi_[i]), std::log(psi_[i + 1]), segment.m + 2);
        else
            sum += integrate(weighted, psi_[i], psi_[i + 1],
                             segment.law == Law::exponential ? segment.m : 1.0);
    }
    return 2 * std::numbers::pi * sum;
}

void PiecewiseFunction::scale(double factor) {
    for (Segment& segment : segments_) {
        if (segment.law == Law::linear) {
            segment.y *= factor;
            segment.m *= factor;
        } else {
            segment.y += std::log(factor);
        }
    }
}

}  // namespace uw
