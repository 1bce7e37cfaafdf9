#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/grid2d.h"
#include "core/paths/distance_intervals.h"
#include "core/paths/lattice_fit.h"
#include "core/paths/radiance_nodes.h"

namespace uw {

/// Nodes so many steps of the lattice away share their variances: those of one say little.
inline constexpr int k_variance_reach = 2;
/// How far away the nodes are, in steps of the lattice, on which a smoothed node and its error
/// depend.
inline constexpr int k_smoothing_reach = LatticeFit::k_reach + 2 * k_variance_reach;

/// A node whose light is smoothed over those around it.
struct SmoothNode {
    std::optional<NodeSurface> surface;
    /// The distance up to which the water's light is known [m], which may be beyond the node's own
    /// surface; 0: nothing is known.
    double known_to = 0;
    NodeRadiance light;  // that of the water divided by IntervalWeights
    /// The variances that the noise of all nodes around leaves, by band: of the light of the water
    /// on the node's ray, of that on its surface, and of what the surface mirrors.
    std::vector<float> water_variance, diffuse_variance, glossy_variance;
    /// By half of the estimates and band, how much of the water's light and of that on the surface
    /// the last widening of the neighbourhood has brought: where that is no noise, it is alike in
    /// both halves.
    std::array<std::vector<float>, 2> water_shift, diffuse_shift;
    /// Standard errors (NodeLattice::find_errors) by band: of the water's light, divided by the sum
    /// of the ray's IntervalWeights; and of the part of it that indirect light on surfaces makes.
    std::vector<float> water_error, halo_error;
    SurfaceErrors surface_errors;
};

/// Throws InputError if so many nodes, with the copies that smoothing makes, do not fit into free
/// memory. `groups`: of RadianceEstimator.
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
/// either half of the estimates is chosen by the values and the variances of the other one: if a
/// half chose its own, a rare bright path would stop the smoothing around it and be counted there
/// once more, or, if its spread widened it, be smoothed over nodes that are counted less.
/// `groups`: of RadianceEstimator.
Grid2D<SmoothNode> smoothed_surfaces(const Grid2D<RadianceNode>& raw, std::size_t groups,
                                     std::size_t bands);
void smooth_water(const Grid2D<RadianceNode>& raw, const NodeWindow& window,
                  const DistanceIntervals& intervals, std::size_t groups, std::size_t bands,
                  Grid2D<SmoothNode>& nodes);

}  // namespace uw
