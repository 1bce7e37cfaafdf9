#include "core/paths/scattering_tables.h"

#include <cmath>
#include <numbers>

namespace uw {

namespace {

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
}

}  // namespace uw
