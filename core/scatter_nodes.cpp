#include "core/scatter_nodes.h"

#include <cmath>

namespace uw {

void ScatterNodes::clear() {
    s.clear();
    weight.clear();
    radius.clear();
    psi.clear();
    end.clear();
    position.clear();
}

void ScatterNodes::look_up(const ConcentrationProfile& profile) {
    const auto constituents = static_cast<std::size_t>(profile.constituent_count);
    concentration.resize(size() * constituents);
    ray_column.resize(size() * constituents);
    std::size_t knot = 0;
    for (std::size_t i = 0; i < size(); ++i) {
        while (knot + 2 < profile.s.size() && profile.s[knot + 1] < s[i]) ++knot;
        const double length = profile.s[knot + 1] - profile.s[knot];
        const double t = (s[i] - profile.s[knot]) / length;
        for (std::size_t k = 0; k < constituents; ++k) {
            const std::size_t at = knot * constituents + k;
            const double begin = profile.concentration[at];
            const double slope = profile.concentration[at + constituents] - begin;
            concentration[i * constituents + k] = begin + t * slope;
            ray_column[i * constituents + k] =
                profile.column[at] + t * length * (begin + 0.5 * t * slope);
        }
    }
}

void ScatterNodes::evaluate_phases(const Medium& medium) {
    phase.resize(size() * medium.phase_functions.size());
    for (std::size_t m = 0; m < medium.phase_functions.size(); ++m)
        medium.phase_functions[m]->evaluate(psi,
                                            std::span<double>(phase).subspan(m * size(), size()));
}

ScatterSum::ScatterSum(const Medium& medium)
    : attenuation_(medium), uniform_(medium.uniform.scattering) {
    for (const Constituent& constituent : medium.constituents)
        constituents_.push_back(constituent.per_unit.scattering);
}

void ScatterSum::add(const ScatterNodes& nodes, const Spectrum& intensity,
                     std::span<Spectrum> radiance) const {
    const std::size_t constituents = constituents_.size();
    const std::size_t phases = uniform_.size();
    const auto bands = static_cast<std::size_t>(attenuation_.band_count);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        Spectrum tau{};
        Spectrum beta{};
        const double length = nodes.s[i] + nodes.radius[i];
        for (std::size_t b = 0; b < bands; ++b) tau[b] = attenuation_.uniform[b] * length;
        for (std::size_t m = 0; m < phases; ++m) {
            const double p = nodes.phase[m * nodes.size() + i];
            for (std::size_t b = 0; b < bands; ++b) beta[b] += p * uniform_[m][b];
        }
        for (std::size_t k = 0; k < constituents; ++k) {
            const std::size_t at = i * constituents + k;
            const double column = nodes.lamp_column[at] + nodes.ray_column[at];
            for (std::size_t b = 0; b < bands; ++b)
                tau[b] += attenuation_.constituents[k][b] * column;
            const double nu = nodes.concentration[at];
            if (nu == 0) continue;
            for (std::size_t m = 0; m < phases; ++m) {
                const double p = nu * nodes.phase[m * nodes.size() + i];
                for (std::size_t b = 0; b < bands; ++b) beta[b] += p * constituents_[k][m][b];
            }
        }
        Spectrum& sum = radiance[nodes.end[i]];
        for (std::size_t b = 0; b < bands; ++b)
            sum[b] += intensity[b] * nodes.weight[i] * std::exp(-tau[b]) * beta[b];
    }
}

}  // namespace uw
