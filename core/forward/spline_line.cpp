#include "core/forward/spline_line.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace uw {

namespace {

bool has_small_factors(int count) {
    for (const int prime : {2, 3, 5})
        while (count % prime == 0) count /= prime;
    return count == 1;
}

// The quintic B-spline at a distance of `x` nodes.
double quintic(double x) {
    const auto power = [x](double reach) {
        const double t = std::max(0.0, reach - x);
        return t * t * t * t * t;
    };
    return (power(3) - 6 * power(2) + 15 * power(1)) / 120;
}

}  // namespace

SplineLine::SplineLine(int pixels, int nodes) : nodes_(nodes) {
    if (nodes == pixels) return;
    for (int i = 0; i < pixels; ++i) {
        const double at = (i + 0.5) * nodes / pixels - 0.5;
        const double before = std::floor(at);
        Taps taps;
        for (std::size_t n = 0; n < k_taps; ++n) {
            const int node = static_cast<int>(before) - 2 + static_cast<int>(n);
            taps.nodes[n] = reflected(node);
            taps.weights[n] = quintic(std::abs(at - node));
        }
        taps_.push_back(taps);
    }
}

/// The node that a node beyond either end is the mirror image of.
int SplineLine::reflected(int node) const {
    const int place = ((node % (2 * nodes_)) + 2 * nodes_) % (2 * nodes_);
    return place < nodes_ ? place : 2 * nodes_ - 1 - place;
}

void SplineLine::spread(std::span<const double> pixels, std::span<double> nodes) const {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (pixels[i] == 0) continue;
        const Taps& taps = taps_[i];
        for (std::size_t n = 0; n < k_taps; ++n)
            nodes[static_cast<std::size_t>(taps.nodes[n])] += taps.weights[n] * pixels[i];
    }
}

void SplineLine::interpolate(std::span<const double> nodes, std::span<double> pixels) const {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Taps& taps = taps_[i];
        double sum = 0;
        for (std::size_t n = 0; n < k_taps; ++n)
            sum += taps.weights[n] * nodes[static_cast<std::size_t>(taps.nodes[n])];
        pixels[i] = sum;
    }
}

double SplineLine::response(int k) const {
    if (is_identity() || k == 0) return 1;
    const double x = 0.5 * std::numbers::pi * k / nodes_;
    const double sinc = std::sin(x) / x;
    return sinc * sinc * sinc * sinc * sinc * sinc;
}

int SplineLine::node_count(int pixels, double spacing) {
    constexpr int k_least = 16;
    int count = std::max(k_least, static_cast<int>(std::ceil(pixels / spacing)));
    while (count < pixels && !has_small_factors(count)) ++count;
    return std::min(count, pixels);
}

}  // namespace uw
