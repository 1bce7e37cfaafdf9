#include "core/light/half_tangent_density.h"

#include <bit>
#include <cmath>

namespace uw {

namespace {

constexpr double k_min_h = 0x1p-24, k_max_h = 0x1p24;
constexpr int k_density_cell_bits = 4;  // of the mantissa: 16 cells per octave
constexpr int k_density_offset_bits = 52 - k_density_cell_bits;
constexpr std::uint64_t k_first_density_cell =
    std::bit_cast<std::uint64_t>(k_min_h) >> k_density_offset_bits;
// The cells of the octaves, after the one from 0 to k_min_h.
constexpr std::size_t k_density_cells =
    1 + (std::bit_cast<std::uint64_t>(k_max_h) >> k_density_offset_bits) - k_first_density_cell;
constexpr std::size_t k_guides = 1024;

std::vector<double> make_nodes() {
    std::vector<double> nodes{0.0};
    for (std::uint64_t cell = 0; cell < k_density_cells; ++cell)
        nodes.push_back(
            std::bit_cast<double>((k_first_density_cell + cell) << k_density_offset_bits));
    return nodes;
}

// The cell that contains `h`; its nodes are `cell` and `cell` + 1. Precondition: h < k_max_h.
std::size_t cell_of(double h) {
    if (h < k_min_h) return 0;
    return static_cast<std::size_t>((std::bit_cast<std::uint64_t>(h) >> k_density_offset_bits) -
                                    k_first_density_cell) +
           1;
}

}  // namespace

std::span<const double> HalfTangentDensity::nodes() {
    static const std::vector<double> all = make_nodes();
    return all;
}

HalfTangentDensity::HalfTangentDensity(std::span<const double> at_nodes) {
    const std::span<const double> h = nodes();
    for (std::size_t i = 0; i < k_density_cells; ++i) {
        const double width = h[i + 1] - h[i];
        cells_.push_back({h[i], mass_, at_nodes[i], (at_nodes[i + 1] - at_nodes[i]) / width});
        mass_ += 0.5 * (at_nodes[i] + at_nodes[i + 1]) * width;
    }
    cells_.push_back({h[k_density_cells], mass_, 0, 0});
    guides_.assign(k_guides, 0);
    if (!(mass_ > 0)) return;
    guides_per_mass_ = k_guides / mass_;
    std::size_t cell = 0;
    for (std::size_t i = 0; i < k_guides; ++i) {
        const double begin = static_cast<double>(i) / guides_per_mass_;
        while (cell + 1 < k_density_cells && cells_[cell + 1].before <= begin) ++cell;
        guides_[i] = static_cast<std::uint16_t>(cell);
    }
}

double HalfTangentDensity::mass_to(double h) const {
    if (!(h < k_max_h)) return mass_;
    const Cell& cell = cells_[cell_of(h)];
    const double t = h - cell.begin;
    return cell.before + t * (cell.value + 0.5 * t * cell.slope);
}

double HalfTangentDensity::density(double h) const {
    if (!(h < k_max_h)) return 0;
    const Cell& cell = cells_[cell_of(h)];
    return cell.value + (h - cell.begin) * cell.slope;
}

double HalfTangentDensity::invert(double mass) const {
    const auto guide = static_cast<std::size_t>(mass * guides_per_mass_);
    std::size_t i = guides_[std::min(guide, k_guides - 1)];
    while (i + 1 < k_density_cells && cells_[i + 1].before <= mass) ++i;
    const Cell& cell = cells_[i];
    const double rest = std::max(0.0, mass - cell.before);
    // Solves rest = value t + slope t^2 / 2 for t, in a form without cancellation.
    const double root = std::sqrt(std::max(0.0, cell.value * cell.value + 2 * cell.slope * rest));
    const double sum = cell.value + root;
    return cell.begin +
           (sum > 0 ? std::min(cells_[i + 1].begin - cell.begin, 2 * rest / sum) : 0.0);
}

Vector3 direction_around(const Vector3& axis, double h, double azimuth) {
    const auto [u, v] = Tangents(axis);
    const double norm = 1 / (1 + h * h);
    const double sine = 2 * h * norm, cosine = (1 - h * h) * norm;
    const double phi = 2 * std::numbers::pi * azimuth;
    return glm::normalize(cosine * axis + sine * (std::cos(phi) * u + std::sin(phi) * v));
}

double half_tangent_between(const Vector3& a, const Vector3& b) {
    const Vector3 difference = a - b, sum = a + b;
    const double square = glm::dot(sum, sum);
    if (!(square > 1e-14)) return 1e7;  // opposite
    return std::max(1e-16, std::sqrt(glm::dot(difference, difference) / square));
}

}  // namespace uw
