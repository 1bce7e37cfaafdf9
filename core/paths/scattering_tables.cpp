#include "core/paths/scattering_tables.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace uw {

namespace {

// The table of spread_glow, linear in h between its nodes: 4 to an octave, at the ends of cells
// that the leading bits of h number.
constexpr double k_glow_least = 0x1p-12, k_glow_most = 0x1p8;
constexpr int k_glow_offset_bits = 50;
constexpr std::uint64_t k_glow_first =
    std::bit_cast<std::uint64_t>(k_glow_least) >> k_glow_offset_bits;
constexpr std::uint64_t k_glow_last =
    std::bit_cast<std::uint64_t>(k_glow_most) >> k_glow_offset_bits;

// Shares of the phase functions in a lobe that serves all of the water: those of the scattering
// coefficients of everything in it.
std::vector<double> typical_shares(const Medium& medium) {
    std::vector<double> shares(medium.phase_functions.size(), 0.0);
    const auto bands = static_cast<std::size_t>(medium.band_count());
    const auto include = [&](const OpticalCoefficients& coefficients) {
        double all = 0;
        for (const Spectrum& b : coefficients.scattering)
            for (const double value : b.first(bands)) all += value;
        if (!(all > 0)) return;
        for (std::size_t m = 0; m < shares.size(); ++m)
            for (const double value : coefficients.scattering[m].first(bands))
                shares[m] += value / all;
    };
    include(medium.uniform);
    for (const Constituent& constituent : medium.constituents) include(constituent.per_unit);
    double sum = 0;
    for (const double share : shares) sum += share;
    for (double& share : shares) share = sum > 0 ? share / sum : 0;
    return shares;
}

}  // namespace

ScatteringTables::ScatteringTables(const Medium& medium)
    : phases(medium), shares(typical_shares(medium)) {
    const std::span<const double> nodes = HalfTangentDensity::nodes();
    const std::size_t count = medium.phase_functions.size();
    std::vector<double> p(count * nodes.size());
    phases.evaluate(nodes, p);
    std::vector<double> of_lobe(nodes.size(), 0.0);
    for (std::size_t m = 0; m < count; ++m) {
        std::vector<double> direction, line;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const double h = nodes[i], dpsi = 2 / (1 + h * h), sine = h * dpsi;
            line.push_back(p[m * nodes.size() + i] * dpsi);
            direction.push_back(2 * std::numbers::pi * line.back() * sine);
        }
        directions.emplace_back(direction);
        lines.emplace_back(line);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const double beyond = lines[m].mass() - lines[m].mass_to(nodes[i]);
            of_lobe[i] += shares[m] * beyond * 2 / (1 + nodes[i] * nodes[i]);
        }
    }
    lobe = HalfTangentDensity(of_lobe);
    spread();
}

double ScatteringTables::spread_glow(double half_tangent) const {
    constexpr std::uint64_t k_offset_mask = (std::uint64_t{1} << k_glow_offset_bits) - 1;
    constexpr double k_offset_unit = 1.0 / (std::uint64_t{1} << k_glow_offset_bits);
    if (!(half_tangent < k_glow_most)) return spread_glow_.back();
    const auto bits = std::bit_cast<std::uint64_t>(std::max(half_tangent, k_glow_least));
    const double* cell = &spread_glow_[(bits >> k_glow_offset_bits) - k_glow_first];
    const double t = static_cast<double>(bits & k_offset_mask) * k_offset_unit;
    return cell[0] + t * (cell[1] - cell[0]);
}

// By a few directions drawn evenly from each phase function.
void ScatteringTables::spread() {
    constexpr int k_angles = 48, k_azimuths = 12;
    for (std::uint64_t node = k_glow_first; node <= k_glow_last; ++node) {
        const double psi = 2 * std::atan(std::bit_cast<double>(node << k_glow_offset_bits));
        double sum = 0;
        for (std::size_t m = 0; m < shares.size(); ++m) {
            for (int angle = 0; angle < k_angles; ++angle) {
                const double h =
                    directions[m].invert((angle + 0.5) / k_angles * directions[m].mass());
                const double theta = 2 * std::atan(h);
                for (int azimuth = 0; azimuth < k_azimuths; ++azimuth) {
                    const double phi = std::numbers::pi * (azimuth + 0.5) / k_azimuths;
                    const double cosine = std::cos(psi) * std::cos(theta) +
                                          std::sin(psi) * std::sin(theta) * std::cos(phi);
                    const double to_lamp = std::acos(std::clamp(cosine, -1.0, 1.0));
                    // Not nearer to the lamp than these directions resolve.
                    const double sine =
                        std::max(std::sin(to_lamp), 0.3 / k_azimuths * std::sin(theta));
                    sum += shares[m] * beyond(std::tan(0.5 * to_lamp)) / std::max(sine, 1e-6);
                }
            }
        }
        spread_glow_.push_back(sum / (k_angles * k_azimuths));
    }
}

}  // namespace uw
