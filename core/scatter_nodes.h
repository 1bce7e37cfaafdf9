#pragma once

#include <span>
#include <vector>

#include "core/concentration_field.h"
#include "core/medium.h"
#include "core/optical_depth.h"

namespace uw {

/// Quadrature nodes of one lamp along one ray, as structure of arrays; reused between rays.
struct ScatterNodes {
    std::vector<double> s;              // along the ray [m], ascending
    std::vector<double> weight;         // ds * relative intensity / R^2 [1/m]
    std::vector<double> radius;         // distance from the lamp R [m]
    std::vector<double> psi;            // scattering angle [rad]
    std::vector<std::size_t> end;       // index of the first of the ray's ends beyond the node
    std::vector<Point3> position;       // world
    std::vector<double> lamp_column;    // lamp to node, [node * constituents + k]
    std::vector<double> concentration;  // at the node, same layout
    std::vector<double> ray_column;     // ray origin to node, same layout
    std::vector<double> phase;          // p_m(psi), [m * nodes + node], 1/sr

    std::size_t size() const { return s.size(); }
    void clear();
    /// Fills concentration and ray_column from the ray's profile.
    void look_up(const ConcentrationProfile& profile);
    /// Fills phase from psi.
    void evaluate_phases(const Medium& medium);
};

/// Coefficients of a medium laid out for summing nodes.
class ScatterSum {
  public:
    explicit ScatterSum(const Medium& medium);

    const AttenuationTable& attenuation() const { return attenuation_; }

    /// Adds intensity * weight * e^-tau * beta(psi) of every node to radiance[node.end]:
    /// the in-scatter between the ends before and after it [W m^-2 sr^-1].
    void add(const ScatterNodes& nodes, const Spectrum& intensity,
             std::span<Spectrum> radiance) const;

  private:
    AttenuationTable attenuation_;
    std::vector<Spectrum> uniform_;                    // b_m [m]
    std::vector<std::vector<Spectrum>> constituents_;  // b*_{k,m} [k][m]
};

}  // namespace uw
