#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/ray.h"

namespace uw {

/// Visibility and column concentrations along the light paths of one emitter, precomputed by
/// splatting so that integrators need not trace shadow rays. Thread safe.
class DeepShadow {
  public:
    virtual ~DeepShadow() = default;

    /// The parts of the interval `stretch` of `ray` that the lamp illuminates, ascending and
    /// disjoint. Precondition: the interval lies within the lamp's beam (Lamp::beam); elsewhere the
    /// map is empty.
    virtual void lit_intervals(const Ray& ray, const Interval& stretch,
                               std::vector<Interval>& lit) const = 0;

    /// Appends distances along `ray` inside `interval` between which the lamp's columns are nearly
    /// linear; nothing where its light has crossed no grid.
    virtual void append_column_breaks(const Ray& ray, const Interval& interval,
                                      std::vector<double>& s) const = 0;

    /// Column concentrations from the lamp to each point, [i * constituent_count + k], [unit m].
    virtual void columns(std::span<const Point3> x, std::span<double> column) const = 0;

    /// Of memory.
    virtual std::size_t bytes() const = 0;
};

}  // namespace uw
