#pragma once

#include <cstddef>

#include "core/base/grid2d.h"
#include "core/multiple/distance_intervals.h"
#include "core/multiple/multiple_nodes.h"

namespace uw {

/// How far away the nodes are, in steps of the lattice, on which a node depends by share_outliers.
inline constexpr int k_sharing_reach = 6;

/// Takes from nodes what rare bright paths have left there, and shares it among the nodes around:
/// the sum stays what it was, and no node is far brighter than all others. The light of a feature
/// shows in both halves of a node; a half is limited only as far as it exceeds the other half, too.
/// `groups`: MultipleNodeOptions::groups.
void share_outliers(Grid2D<MultipleNode>& nodes, const DistanceIntervals& intervals,
                    std::size_t groups);

}  // namespace uw
