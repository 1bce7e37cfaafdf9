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

/// Variances are averaged over the nodes within so many steps of the lattice: that of a single node
/// is too noisy.
inline constexpr int k_variance_radius = 2;
/// The distance, in steps of the lattice, of the farthest nodes on which a smoothed node and its
/// error depend.
inline constexpr int k_smoothing_radius = LatticeFit::k_max_radius + 2 * k_variance_radius + 1;

/// A node whose light is smoothed over those around it.
struct SmoothNode {
    std::optional<NodeSurface> surface;
    /// The distance up to which the water's light is known [m]; may be beyond the node's own
    /// surface. 0: nothing is known.
    double known_to = 0;
    NodeRadiance light;  // the water's is divided by IntervalWeights
    /// Variances that remain from the noise of the nodes around, by band: of the light of the water
    /// on the node's ray, of the light on its surface, and of what the surface mirrors.
    std::vector<float> water_variance, diffuse_variance, glossy_variance;
    /// By half of the estimates and band: by how much the last widening of the neighbourhood
    /// changed the water's light and that on the surface. A change that is not noise is alike in
    /// both halves.
    std::array<std::vector<float>, 2> water_shift, diffuse_shift;
    /// Standard errors by band (NodeLattice::find_errors): of the water's light, divided by the sum
    /// of the ray's IntervalWeights; and of the part of it that comes from indirect light on
    /// surfaces.
    std::vector<float> water_error, halo_error;
    SurfaceErrors surface_errors;
};

/// Throws InputError if this many nodes, with the copies that smoothing makes, do not fit into free
/// memory. `groups`: see RadianceEstimator.
void require_room_for_nodes(std::size_t nodes, std::size_t intervals, std::size_t groups,
                            const LitScene& scene);

/// A rectangle of a lattice of nodes, by index.
struct NodeWindow {
    int i0 = 0, j0 = 0, i1 = 0, j1 = 0;  // [first, past the last)

    std::size_t size() const {
        return static_cast<std::size_t>(i1 - i0) * static_cast<std::size_t>(j1 - j0);
    }
};

/// Smooths the nodes of a lattice by LatticeFit: first the light on surfaces, over the nodes that
/// see the same surface; then, in a window, the light of the water, interval by interval, over the
/// nodes whose rays reach it. The neighbourhood for either half of the estimates is chosen by the
/// values and variances of the other half. If a half chose its own, a rare bright path would stop
/// the smoothing around itself and be counted twice; or its spread would widen the neighbourhood to
/// nodes of lower weight. Both halves take the same neighbourhood, which the nodes next to it bear
/// out. `groups`: see RadianceEstimator.
Grid2D<SmoothNode> smoothed_surfaces(const Grid2D<RadianceNode>& raw, std::size_t groups,
                                     std::size_t bands);
void smooth_water(const Grid2D<RadianceNode>& raw, const NodeWindow& window,
                  const DistanceIntervals& intervals, std::size_t groups, std::size_t bands,
                  Grid2D<SmoothNode>& nodes);

}  // namespace uw
