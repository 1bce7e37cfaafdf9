#pragma once

#include <cstddef>

#include "core/base/grid2d.h"
#include "core/paths/distance_intervals.h"
#include "core/paths/lattice_fit.h"
#include "core/paths/multiple_nodes.h"

namespace uw {

/// How far away the nodes are, in steps of the lattice, on which a smoothed node depends.
inline constexpr int k_smoothing_reach = LatticeFit::k_reach + 2;

/// A node whose light is smoothed over those around it.
struct SmoothNode {
    std::optional<NodeSurface> surface;
    /// The distance up to which the water's light is known [m], which may be beyond the node's own
    /// surface; 0: nothing is known.
    double known_to = 0;
    NodeLight light;        // that of the water divided by IntervalWeights
    double mean_light = 0;  // of the node's ray
    /// Half the difference between what either half of the estimates makes of its water's light,
    /// and of the light on its surface, by band: their squares are the variances of the halves'
    /// mean, whatever smoothing has made of them.
    std::vector<float> water_deviation, diffuse_deviation;
};

/// Throws InputError if so many nodes, with the copies that smoothing makes, do not fit into free
/// memory. `groups`: of MultipleNodes.
void require_room_for_nodes(std::size_t nodes, std::size_t intervals, std::size_t groups,
                            const LitScene& scene);

/// A part of a lattice of nodes, by index.
struct NodeWindow {
    int i0 = 0, j0 = 0, i1 = 0, j1 = 0;  // [first, past the last)

    std::size_t size() const {
        return static_cast<std::size_t>(i1 - i0) * static_cast<std::size_t>(j1 - j0);
    }
};

/// Smooths the nodes of a lattice (LatticeFit):
/// first the surfaces' light over the nodes that see the same surface, and then, in a window, the
/// water's interval by interval over the nodes whose rays reach it. The neighbourhood for
/// either half of the estimates is chosen by the other one: if a half chose its own, a rare bright
/// path would stop the smoothing around it and be counted there once more. `groups`: of
/// MultipleNodes.
Grid2D<SmoothNode> smoothed_surfaces(const Grid2D<MultipleNode>& raw, std::size_t groups,
                                     std::size_t bands);
void smooth_water(const Grid2D<MultipleNode>& raw, const NodeWindow& window,
                  const DistanceIntervals& intervals, std::size_t groups, std::size_t bands,
                  Grid2D<SmoothNode>& nodes);

}  // namespace uw
