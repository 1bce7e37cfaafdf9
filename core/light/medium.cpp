#include "core/light/medium.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/base/numerics.h"

namespace uw {

AttenuationTable::AttenuationTable(const Medium& medium)
    : uniform(medium.uniform.attenuation()), band_count(medium.band_count()) {
    for (const Constituent& constituent : medium.constituents)
        constituents.push_back(constituent.per_unit.attenuation());
}

Spectrum AttenuationTable::transmittance(double length, std::span<const double> columns) const {
    return per_band(static_cast<std::size_t>(band_count), [&](std::size_t band) {
        return exp_of_minus(optical_depth(band, length, columns));
    });
}

namespace {

constexpr double k_min_half_tangent = PhaseFunction::k_min_half_tangent;
constexpr double k_max_half_tangent = PhaseFunction::k_max_half_tangent;
constexpr int k_cell_bits = 6;  // of the mantissa: 64 cells per octave
constexpr int k_offset_bits = 52 - k_cell_bits;
constexpr std::uint64_t k_first = std::bit_cast<std::uint64_t>(k_min_half_tangent) >> k_offset_bits;
constexpr std::size_t k_cells =
    (std::bit_cast<std::uint64_t>(k_max_half_tangent) >> k_offset_bits) - k_first;

double angle(double half_tangent) {
    return 2 * std::atan(half_tangent);
}

double cell_begin(std::size_t cell) {
    return std::bit_cast<double>((k_first + cell) << k_offset_bits);
}

}  // namespace

PhaseTable::PhaseTable(const Medium& medium)
    : phases_(medium.phase_functions.size()), coefficients_(k_cells * phases_ * 3) {
    for (std::size_t cell = 0; cell < k_cells; ++cell) {
        const double begin = cell_begin(cell), end = cell_begin(cell + 1);
        const std::array<double, 3> psi{angle(begin), angle(0.5 * (begin + end)), angle(end)};
        for (std::size_t m = 0; m < phases_; ++m) {
            std::array<double, 3> p{};
            medium.phase_functions[m]->eval(psi, p);
            double* c = &coefficients_[(cell * phases_ + m) * 3];
            c[0] = p[0];
            c[1] = 4 * p[1] - 3 * p[0] - p[2];
            c[2] = 2 * p[0] - 4 * p[1] + 2 * p[2];
        }
    }
}

UWVDB_VECTOR_CLONES void PhaseTable::eval(std::span<const double> half_tangent,
                                          std::span<double> p) const {
    if (phases_ == 0) return;  // non-scattering water has no table
    constexpr std::uint64_t k_offset_mask = (std::uint64_t{1} << k_offset_bits) - 1;
    constexpr double k_offset_unit = 1.0 / (std::uint64_t{1} << k_offset_bits);
    const double largest = std::nextafter(k_max_half_tangent, 0);
    const std::size_t count = half_tangent.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double h = std::clamp(half_tangent[i], k_min_half_tangent, largest);
        const auto bits = std::bit_cast<std::uint64_t>(h);
        const double t = static_cast<double>(bits & k_offset_mask) * k_offset_unit;
        const double* c = &coefficients_[((bits >> k_offset_bits) - k_first) * phases_ * 3];
        for (std::size_t m = 0; m < phases_; ++m, c += 3)
            p[m * count + i] = std::max(0.0, c[0] + t * (c[1] + t * c[2]));
    }
}

DepthTolerance::DepthTolerance(const Medium& medium, double optical_depth)
    : optical_depth_(optical_depth) {
    const AttenuationTable attenuation(medium);
    const auto bands = static_cast<std::size_t>(attenuation.band_count);
    min_uniform_ = attenuation.uniform.least(bands);
    for (const Spectrum& per_unit : attenuation.constituents) {
        min_per_unit_.push_back(per_unit.least(bands));
        max_per_unit_.push_back(per_unit.greatest(bands));
    }
}

bool DepthTolerance::allows(std::span<const double> error, double length,
                            std::span<const double> before) const {
    double depth = 0;
    for (std::size_t k = 0; k < max_per_unit_.size(); ++k)
        depth += max_per_unit_[k] * std::abs(error[k]);
    return depth <= optical_depth_ ||
           depth * exp_of_minus(min_depth(length, before)) <= optical_depth_;
}

double DepthTolerance::min_depth(double length, std::span<const double> columns) const {
    double depth = min_uniform_ * length;
    for (std::size_t k = 0; k < min_per_unit_.size(); ++k) depth += min_per_unit_[k] * columns[k];
    return depth;
}

std::vector<double> typical_phase_fractions(const Medium& medium) {
    std::vector<double> fractions(medium.phase_functions.size(), 0.0);
    const auto bands = static_cast<std::size_t>(medium.band_count());
    const auto include = [&](const OpticalCoefficients& coefficients) {
        double all = 0;
        for (const Spectrum& b : coefficients.scattering)
            for (const double value : b.first(bands)) all += value;
        if (!(all > 0)) return;
        for (std::size_t m = 0; m < fractions.size(); ++m)
            for (const double value : coefficients.scattering[m].first(bands))
                fractions[m] += value / all;
    };
    include(medium.uniform);
    for (const Constituent& constituent : medium.constituents) include(constituent.per_unit);
    double sum = 0;
    for (const double fraction : fractions) sum += fraction;
    for (double& fraction : fractions) fraction = sum > 0 ? fraction / sum : 0;
    return fractions;
}

void ConcentrationProfile::integrate() {
    const auto count = static_cast<std::size_t>(constituent_count);
    column.assign(concentration.size(), 0.0);
    for (std::size_t knot = 1; knot < s.size(); ++knot) {
        const double half = 0.5 * (s[knot] - s[knot - 1]);
        for (std::size_t i = knot * count; i < (knot + 1) * count; ++i) {
            const double sum = concentration[i] + concentration[i - count];
            column[i] = column[i - count];
            // Avoids 0 * infinity on an unbounded ray.
            if (sum != 0) column[i] += half * sum;
        }
    }
}

}  // namespace uw
