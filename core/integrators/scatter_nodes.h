#pragma once

#include <span>
#include <vector>

#include "core/integrators/path_weight.h"
#include "core/optics/concentration_field.h"
#include "core/optics/medium.h"
#include "core/optics/optical_depth.h"
#include "core/optics/phase_table.h"

namespace uw {

/// Quadrature nodes of one lamp along one ray, as structure of arrays; reused between rays.
struct ScatterNodes {
    std::vector<double> s;              // along the ray [m], ascending
    std::vector<double> weight;         // ds * relative intensity / Lamp::spread [1/m; a sun: m]
    std::vector<double> radius;         // distance from the light's origin R [m]
    std::vector<double> half_tangent;   // tan(psi / 2) of the scattering angle
    std::vector<std::size_t> distance;  // index of the first requested distance beyond the node
    std::vector<Point3> position;       // world
    std::vector<double> lamp_column;    // lamp to node, [node * constituents + k]
    // Filled by look_up and evaluate_phases:
    std::vector<double> column;         // lamp to node to ray origin, [k * nodes + node]
    std::vector<double> concentration;  // at the node, same layout
    std::vector<double> phase;          // p_m(psi), [m * nodes + node], 1/sr

    std::size_t size() const { return s.size(); }
    void clear();
    /// Fills column and concentration from the ray's profile and lamp_column.
    void look_up(const ConcentrationProfile& profile);
    /// Multiplies every node's weight by that of its path, from lamp to node to the ray's origin.
    /// After look_up.
    void weigh(const PathWeight& path_weight);
    /// Fills phase from half_tangent; `phases` is the number of phase functions in the table.
    void evaluate_phases(const PhaseTable& table, std::size_t phases);
};

/// Coefficients of a medium, laid out for summation over nodes.
class ScatterSum {
  public:
    explicit ScatterSum(const Medium& medium);

    const AttenuationTable& attenuation() const { return attenuation_; }

    /// Adds intensity * weight * e^-tau * beta(psi) of every node to radiance[node.distance], which
    /// collects the in-scatter between the distances before and after the node [W m^-2 sr^-1].
    void add(const ScatterNodes& nodes, const Spectrum& intensity,
             std::span<Spectrum> radiance) const;

  private:
    // Scattering by constituent k, or by the uniform water, with phase function m.
    struct Term {
        std::size_t m;
        std::size_t k;
        Spectrum scattering;
    };

    void add_depth(const ScatterNodes& nodes, std::size_t band, std::span<double> tau) const;
    void add_scattering(const ScatterNodes& nodes, std::size_t band, std::span<double> beta) const;

    AttenuationTable attenuation_;
    std::vector<Spectrum> uniform_;  // b_m [m]
    std::vector<Term> terms_;        // non-zero b*_{k,m}
};

}  // namespace uw
