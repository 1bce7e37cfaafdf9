#include "core/paths/scattering_tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {

ScatteringTables::ScatteringTables(const Medium& medium,
                                   const LampRadianceTable::Fineness& fineness)
    : phases(medium), phase_fractions(typical_phase_fractions(medium)), fineness_(fineness) {
    const std::span<const double> nodes = HalfTangentDensity::nodes();
    std::vector<double> p(medium.phase_functions.size() * nodes.size()), line(nodes.size());
    phases.eval(nodes, p);
    for (std::size_t m = 0; m < medium.phase_functions.size(); ++m) {
        directions.push_back(medium.phase_functions[m]->make_sampler());
        for (std::size_t i = 0; i < nodes.size(); ++i)
            line[i] = p[m * nodes.size() + i] * (2 / (1 + nodes[i] * nodes[i]));
        lines.emplace_back(line);
    }
    const auto include = [&](const OpticalCoefficients& coefficients) {
        for (std::size_t b = 0; b < static_cast<std::size_t>(medium.band_count()); ++b) {
            const double c = coefficients.attenuation(b);
            if (!(c > 0)) continue;
            const double albedo = coefficients.total_scattering()[b] / c;
            min_albedo_ = std::min(min_albedo_, albedo);
            max_albedo_ = std::max(max_albedo_, albedo);
        }
    };
    include(medium.uniform);
    for (const Constituent& constituent : medium.constituents) include(constituent.per_unit);
}

const LampRadianceTable& ScatteringTables::lamp_radiance() const {
    const std::lock_guard lock(lamp_radiance_mutex_);
    if (!lamp_radiance_) lamp_radiance_ = make_lamp_radiance();
    return *lamp_radiance_;
}

LampRadianceTable ScatteringTables::make_lamp_radiance() const {
    std::vector<double> p(phase_count()), of_direction, of_line;
    for (const double h : HalfTangentDensity::nodes()) {
        phase(h, p);
        double mean = 0;
        for (std::size_t m = 0; m < p.size(); ++m) mean += phase_fractions[m] * p[m];
        const double dpsi = 2 / (1 + h * h);
        of_line.push_back(mean * dpsi);
        of_direction.push_back(2 * std::numbers::pi * mean * dpsi * h * dpsi);
    }
    return {HalfTangentDensity(of_direction), HalfTangentDensity(of_line), min_albedo_, max_albedo_,
            fineness_};
}

}  // namespace uw
