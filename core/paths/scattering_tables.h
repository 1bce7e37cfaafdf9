#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/light/half_tangent_density.h"
#include "core/light/medium.h"
#include "core/paths/lamp_radiance_table.h"

namespace uw {

/// The phase functions of a medium, and densities for sampling scattering angles.
struct ScatteringTables {
    PhaseTable phases;
    /// The typical fraction of each phase function in the scattering of all that the water may
    /// contain; they add up to 1.
    std::vector<double> phase_fractions;

    // One per phase function m of the medium:
    /// PhaseFunction::make_sampler: for sampling the direction of a scattering.
    std::vector<HalfTangentDensity> directions;
    /// p_m(psi) over angles, for sampling where on a line a lamp's light is scattered along it: ds
    /// / R^2 = dpsi / D with D the lamp's distance from the line.
    std::vector<HalfTangentDensity> lines;
    /// The radiance around a point lamp by all orders of scattering, for the mean phase function
    /// and the albedos of all that the water may contain. Computed on first use, in about 0.1 s, or
    /// 0.02 s if it is coarse.
    const LampRadianceTable& lamp_radiance() const;

    /// `fineness`: of `lamp_radiance`.
    explicit ScatteringTables(const Medium& medium,
                              const LampRadianceTable::Fineness& fineness = {});
    ScatteringTables(const ScatteringTables&) = delete;
    ScatteringTables& operator=(const ScatteringTables&) = delete;
    ScatteringTables(ScatteringTables&&) = delete;
    ScatteringTables& operator=(ScatteringTables&&) = delete;
    ~ScatteringTables() = default;

    std::size_t phase_count() const { return lines.size(); }
    /// All p_m at `half_tangent` [1/sr].
    void phase(double half_tangent, std::span<double> p) const {
        phases.eval(std::span(&half_tangent, 1), p);
    }

  private:
    LampRadianceTable make_lamp_radiance() const;

    LampRadianceTable::Fineness fineness_;
    double min_albedo_ = 1, max_albedo_ = 0;
    mutable std::mutex lamp_radiance_mutex_;
    mutable std::optional<LampRadianceTable> lamp_radiance_;  // computed on first use
};

}  // namespace uw
