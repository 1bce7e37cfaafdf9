#include "core/paths/scattering_tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {

namespace {

// The table of spread_glow.
constexpr int k_first_octave = -12, k_last_octave = 8, k_per_octave = 4;

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

ScatteringTables::ScatteringTables(const Medium& medium) : phases(medium) {
    const std::span<const double> nodes = HalfTangentDensity::nodes();
    const std::size_t count = medium.phase_functions.size();
    std::vector<double> p(count * nodes.size());
    phases.evaluate(nodes, p);
    const std::vector<double> shares = typical_shares(medium);
    std::vector<double> of_lobe(nodes.size(), 0.0);
    for (std::size_t m = 0; m < count; ++m) {
        std::vector<double> direction, line;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const double h = nodes[i], dpsi = 2 / (1 + h * h), sine = h * dpsi;
            line.push_back(p[m * nodes.size() + i] * dpsi);
            direction.push_back(2 * std::numbers::pi * line.back() * sine);
        }
        directions.emplace_back(std::move(direction));
        lines.emplace_back(std::move(line));
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const double beyond = lines[m].mass() - lines[m].mass_to(nodes[i]);
            of_lobe[i] += shares[m] * beyond * 2 / (1 + nodes[i] * nodes[i]);
        }
    }
    lobe = HalfTangentDensity(std::move(of_lobe));
    spread(shares);
}

double ScatteringTables::spread_glow(double half_tangent) const {
    if (spread_glow_.empty()) return 0;
    const double last = static_cast<double>(spread_glow_.size() - 1);
    const double at = std::clamp(
        k_per_octave * (std::log2(std::max(half_tangent, 1e-9)) - k_first_octave), 0.0, last);
    const auto cell = std::min(static_cast<std::size_t>(at), spread_glow_.size() - 2);
    const double t = at - static_cast<double>(cell);
    return (1 - t) * spread_glow_[cell] + t * spread_glow_[cell + 1];
}

// By a few directions drawn evenly from each phase function.
void ScatteringTables::spread(std::span<const double> shares) {
    constexpr int k_angles = 48, k_azimuths = 12;
    for (int i = 0; i <= k_per_octave * (k_last_octave - k_first_octave); ++i) {
        const double psi =
            2 * std::atan(std::exp2(k_first_octave + static_cast<double>(i) / k_per_octave));
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
