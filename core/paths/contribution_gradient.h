#pragma once

#include <span>

#include "core/paths/path_segment.h"

namespace uw {

/// Gathers the derivatives of a number by something that light meets on its way, from those by the
/// light of its paths. For one thread.
class ContributionGradient {
  public:
    virtual ~ContributionGradient() = default;
    /// ContributionSink::turn. One from the camera begins anew, after finish(); numbers count from
    /// 0.
    virtual int add_vertex(int before, const PathVertex& vertex) = 0;
    /// The number changes by worth[band] in proportion to the term's light: its derivative by that,
    /// times it.
    virtual void add(const PathContribution& term, std::span<const double> worth) = 0;
    /// Hands back what all terms since the last camera turn are worth.
    virtual void finish() = 0;
};

}  // namespace uw
