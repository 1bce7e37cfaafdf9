#include "core/integrators/scatter_nodes.h"

#include <algorithm>

#include "core/base/fast_exp.h"
#include "core/base/vector_clones.h"

namespace uw {

void ScatterNodes::clear() {
    s.clear();
    weight.clear();
    radius.clear();
    half_tangent.clear();
    distance.clear();
    position.clear();
}

void ScatterNodes::look_up(const ConcentrationProfile& profile) {
    const auto constituents = static_cast<std::size_t>(profile.constituent_count);
    concentration.resize(size() * constituents);
    column.resize(size() * constituents);
    if (constituents == 0) return;
    std::size_t knot = 0;
    for (std::size_t i = 0; i < size(); ++i) {
        while (knot + 2 < profile.s.size() && profile.s[knot + 1] < s[i]) ++knot;
        const double length = profile.s[knot + 1] - profile.s[knot];
        const double t = (s[i] - profile.s[knot]) / length;
        for (std::size_t k = 0; k < constituents; ++k) {
            const std::size_t at = knot * constituents + k;
            const double begin = profile.concentration[at];
            const double slope = profile.concentration[at + constituents] - begin;
            concentration[k * size() + i] = begin + t * slope;
            column[k * size() + i] = lamp_column[i * constituents + k] + profile.column[at] +
                                     t * length * (begin + 0.5 * t * slope);
        }
    }
}

void ScatterNodes::weigh(const PathWeight& path_weight) {
    const double* const columns = path_weight.kind == PathWeight::Kind::column
                                      ? column.data() + path_weight.constituent * size()
                                      : nullptr;
    for (std::size_t i = 0; i < size(); ++i) weight[i] *= columns ? columns[i] : s[i] + radius[i];
}

void ScatterNodes::evaluate_phases(const PhaseTable& table, std::size_t phases) {
    phase.resize(size() * phases);
    table.evaluate(half_tangent, phase);
}

ScatterSum::ScatterSum(const Medium& medium)
    : attenuation_(medium), uniform_(medium.uniform.scattering) {
    for (std::size_t k = 0; k < medium.constituents.size(); ++k) {
        const std::vector<Spectrum>& scattering = medium.constituents[k].per_unit.scattering;
        for (std::size_t m = 0; m < scattering.size(); ++m)
            if (scattering[m] != Spectrum{}) terms_.push_back({m, k, scattering[m]});
    }
}

UWVDB_VECTOR_CLONES void ScatterSum::add(const ScatterNodes& nodes, const Spectrum& intensity,
                                         std::span<Spectrum> radiance) const {
    thread_local std::vector<double> tau, beta;
    // Band by band, so that each loop runs over contiguous nodes without a branch.
    for (std::size_t b = 0; b < static_cast<std::size_t>(attenuation_.band_count); ++b) {
        tau.assign(nodes.size(), 0.0);
        beta.assign(nodes.size(), 0.0);
        add_depth(nodes, b, tau);
        add_scattering(nodes, b, beta);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            beta[i] *= nodes.weight[i] * exp_of_minus(tau[i]);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            radiance[nodes.distance[i]][b] += intensity[b] * beta[i];
    }
}

UWVDB_VECTOR_CLONES void ScatterSum::add_depth(const ScatterNodes& nodes, std::size_t band,
                                               std::span<double> tau) const {
    const std::size_t count = nodes.size();
    const double c = attenuation_.uniform[band];
    for (std::size_t i = 0; i < count; ++i) tau[i] = c * (nodes.s[i] + nodes.radius[i]);
    for (std::size_t k = 0; k < attenuation_.constituents.size(); ++k) {
        const double per_unit = attenuation_.constituents[k][band];
        const double* column = nodes.column.data() + k * count;
        for (std::size_t i = 0; i < count; ++i) tau[i] += per_unit * column[i];
    }
}

UWVDB_VECTOR_CLONES void ScatterSum::add_scattering(const ScatterNodes& nodes, std::size_t band,
                                                    std::span<double> beta) const {
    const std::size_t count = nodes.size();
    for (std::size_t m = 0; m < uniform_.size(); ++m) {
        const double b = uniform_[m][band];
        const double* p = nodes.phase.data() + m * count;
        for (std::size_t i = 0; i < count; ++i) beta[i] += b * p[i];
    }
    for (const Term& term : terms_) {
        const double b = term.scattering[band];
        const double* p = nodes.phase.data() + term.m * count;
        const double* nu = nodes.concentration.data() + term.k * count;
        for (std::size_t i = 0; i < count; ++i) beta[i] += b * nu[i] * p[i];
    }
}

}  // namespace uw
