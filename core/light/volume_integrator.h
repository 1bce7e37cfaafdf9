#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/light/integrator.h"
#include "core/light/integrator_kind.h"
#include "core/light/lamps_in_view.h"
#include "core/light/medium.h"
#include "core/light/ray_panels.h"
#include "core/light/sky_emitter.h"

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
    /// Makes room for this many nodes.
    void reserve(std::size_t count);
    /// Fills column and concentration from the ray's profile and lamp_column.
    void look_up(const ConcentrationProfile& profile);
    /// Fills phase from half_tangent; `phases` is the number of phase functions in the table.
    void evaluate_phases(const PhaseTable& table, std::size_t phases);
    /// Fills it with values that hold at all nodes, by phase function.
    void set_phases(std::span<const double> values);
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

/// Deterministic quadrature of single scattering (physics section 5) over precomputed (splatted)
/// light: Gauss rules on panels that follow octaves of the distance to the lamp, the phase
/// functions' breakpoints, lit intervals, voxels and the lamp's columns.
class VolumeIntegrator final : public Integrator {
  public:
    /// For every scene whose lamps have been splatted.
    static const IntegratorKind k_kind;

    /// How finely a ray's panels resolve the light on it.
    struct Fineness {
        // Knots of the concentrations per panel, which has at least two nodes; large values are
        // for drafts.
        int knots_per_panel = 2;
        // A break that only marks a change of scale is dropped if its predecessor is closer than
        // this, relative to the distance from the lamp.
        double min_relative_panel = 0.35;
        int pieces = 1;  // the least number into which a panel is divided
        // Where tan(psi / 2) is greater, columns to the lamp are interpolated between the rays of
        // its map; up to there each is integrated.
        double interpolated_half_tangent = 0.27;
    };

    /// Which light is integrated: that of suns that waves focus, all other light, or both.
    struct Part {
        bool focused = true, even = true;
    };

    /// `deep_shadows`: one per emitter of `scene`. `tolerance`: of the concentrations along a ray.
    VolumeIntegrator(const LitScene& scene,
                     std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                     const DepthTolerance& tolerance, const Fineness& fineness, const Part& part);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                         InScatter& result) const override;

    /// One of the quadrature nodes that in_scatter sums up.
    struct Node {
        std::size_t emitter;       // that lights it
        double s;                  // along the ray [m]
        std::size_t distance;      // index of the first of the distances beyond it
        const Spectrum& radiance;  // that it adds [W m^-2 sr^-1]
        // By constituent: the column along the path of its light from the emitter to the ray's
        // origin [unit m], and the concentration at the node [unit].
        std::span<const double> columns, concentration;
    };
    /// Calls `visit` with each of the nodes whose sum is in_scatter.
    void visit_nodes(const Ray& ray, std::span<const double> distances,
                     const std::function<void(const Node&)>& visit) const;

  private:
    struct Workspace;

    // The nodes of an emitter's light beyond `begin`, with all but their radiance.
    void find_nodes(const Ray& ray, std::size_t emitter, double begin,
                    std::span<const double> distances, Workspace& w) const;
    // Where panels begin and end within a lit interval of lamp `lamp`, ascending.
    const std::vector<double>& find_breaks(const Ray& ray, std::size_t lamp,
                                           const LampPassage& passage, const Interval& interval,
                                           std::span<const double> distances, Workspace& w) const;
    // Integrates the lamp columns of nodes that Fineness asks for.
    void refine_columns(std::size_t lamp, ScatterNodes& nodes, int constituents) const;
    void add_panels(const Ray& ray, std::size_t lamp, const LampPassage& passage,
                    std::span<const double> distances, std::span<const double> breaks,
                    const ConcentrationProfile& profile, ScatterNodes& nodes) const;

    LitScene scene_;
    LampEvenness evenness_;
    SkyScattering sky_;
    DepthTolerance tolerance_;
    Fineness fineness_;
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows_;
    std::vector<std::size_t> emitters_;     // those of the part, ascending
    std::vector<double> phase_cotangents_;  // of all phase functions' breakpoints
    PhaseTable phases_;
    ScatterSum sum_;
    double max_attenuation_ = 0;  // of the uniform water over the bands [1/m]
    double min_attenuation_ = 0;
    std::vector<double> max_per_unit_;  // over the bands, per constituent [1/m per unit]
};

}  // namespace uw
