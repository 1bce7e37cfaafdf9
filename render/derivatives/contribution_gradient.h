#pragma once

#include <span>

#include "core/paths/path_segment.h"

namespace uw {

/// Accumulates the derivatives of a scalar by parameters of what light meets on its way
/// (back-propagation), given its derivatives by the contributions of light paths. Not thread safe:
/// one object per thread.
class ContributionGradient {
  public:
    virtual ~ContributionGradient() = default;
    /// As ContributionSink::add_vertex. A vertex without a predecessor, at the camera, begins a new
    /// tree of paths, after finish(); numbers count from 0.
    virtual int add_vertex(int before, const PathVertex& vertex) = 0;
    /// `sensitivity`, by band: the derivative of the scalar by the contribution's radiance times
    /// that radiance, i.e. by its logarithm.
    virtual void add(const PathContribution& contribution, std::span<const double> sensitivity) = 0;
    /// Propagates the sensitivities of all contributions since the last camera vertex to the
    /// parameters.
    virtual void finish() = 0;
};

}  // namespace uw
