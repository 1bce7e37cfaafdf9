#pragma once

#include <span>
#include <vector>

#include "core/base/ray.h"

namespace uw {

/// What one lamp's light meets on its way: visibility and column concentrations, splatted ahead
/// of time so that integrators need not trace. Thread safe.
class DeepShadow {
  public:
    virtual ~DeepShadow() = default;

    /// The parts of a stretch of `ray` that the lamp sees, ascending and disjoint. Precondition:
    /// the stretch lies in the lamp's beam (Lamp::beam); elsewhere the map is empty.
    virtual void lit_intervals(const Ray& ray, const Interval& stretch,
                               std::vector<Interval>& lit) const = 0;

    /// Appends distances along `ray` inside `interval` such that between neighbours the lamp's
    /// columns are close to linear. None where the light has met no grid.
    virtual void append_column_breaks(const Ray& ray, const Interval& interval,
                                      std::vector<double>& s) const = 0;

    /// Column concentrations from the lamp to each point, [i * constituent_count + k], [unit m].
    virtual void columns(std::span<const Point3> x, std::span<double> column) const = 0;
};

}  // namespace uw
