#include "core/paths/half_tangent_density.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace uw {

namespace {

constexpr double k_least = 0x1p-24, k_most = 0x1p24;
constexpr int k_cell_bits = 4;  // of the mantissa: 16 cells per octave
constexpr int k_offset_bits = 52 - k_cell_bits;
constexpr std::uint64_t k_first = std::bit_cast<std::uint64_t>(k_least) >> k_offset_bits;
// Those between powers of two, after the one from 0 to k_least.
constexpr std::size_t k_cells =
    1 + (std::bit_cast<std::uint64_t>(k_most) >> k_offset_bits) - k_first;

std::vector<double> make_nodes() {
    std::vector<double> nodes{0.0};
    for (std::uint64_t cell = 0; cell < k_cells; ++cell)
        nodes.push_back(std::bit_cast<double>((k_first + cell) << k_offset_bits));
    return nodes;
}

// Whose nodes are `cell` and `cell` + 1. Precondition: h < k_most.
std::size_t cell_of(double h) {
    if (h < k_least) return 0;
    return static_cast<std::size_t>((std::bit_cast<std::uint64_t>(h) >> k_offset_bits) - k_first) +
           1;
}

const std::vector<double>& all_nodes() {
    static const std::vector<double> nodes = make_nodes();
    return nodes;
}

}  // namespace

std::span<const double> HalfTangentDensity::nodes() {
    return all_nodes();
}

HalfTangentDensity::HalfTangentDensity(std::vector<double> at_nodes)
    : values_(std::move(at_nodes)), cumulative_(values_.size(), 0.0) {
    const std::vector<double>& h = all_nodes();
    for (std::size_t i = 1; i < values_.size(); ++i)
        cumulative_[i] =
            cumulative_[i - 1] + 0.5 * (values_[i - 1] + values_[i]) * (h[i] - h[i - 1]);
}

double HalfTangentDensity::mass_to(double h) const {
    if (!(h < k_most)) return cumulative_.back();
    const std::size_t cell = cell_of(h);
    const double begin = all_nodes()[cell], end = all_nodes()[cell + 1];
    const double t = (h - begin) / (end - begin);
    return cumulative_[cell] +
           (h - begin) * (values_[cell] + 0.5 * t * (values_[cell + 1] - values_[cell]));
}

double HalfTangentDensity::density(double h) const {
    if (!(h < k_most)) return 0;
    const std::size_t cell = cell_of(h);
    const double begin = all_nodes()[cell], end = all_nodes()[cell + 1];
    return values_[cell] + (h - begin) / (end - begin) * (values_[cell + 1] - values_[cell]);
}

double HalfTangentDensity::invert(double mass) const {
    const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, mass);
    const auto cell = static_cast<std::size_t>(above - cumulative_.begin()) - 1;
    const double begin = all_nodes()[cell], width = all_nodes()[cell + 1] - begin;
    const double rest = std::max(0.0, mass - cumulative_[cell]);
    const double slope = (values_[cell + 1] - values_[cell]) / width;
    // rest = value t + slope t^2 / 2, in a form without cancellation.
    const double root = std::sqrt(std::max(0.0, values_[cell] * values_[cell] + 2 * slope * rest));
    const double sum = values_[cell] + root;
    return begin + (sum > 0 ? std::min(width, 2 * rest / sum) : 0.0);
}

}  // namespace uw
