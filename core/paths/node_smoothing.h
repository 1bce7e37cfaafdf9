#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/grid2d.h"
#include "core/paths/distance_intervals.h"
#include "core/paths/lattice_smoothing.h"
#include "core/paths/radiance_nodes.h"

namespace uw {

/// Variances are averaged over the nodes within so many steps of the lattice: that of a single node
/// is too noisy.
inline constexpr int k_variance_radius = 2;
/// The distance, in steps of the lattice, of the farthest nodes on which a smoothed node and its
/// error depend.
inline constexpr int k_smoothing_radius = k_smoothing_reach + 2 * k_variance_radius;

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
    /// By half of the estimates and band: SmoothedLight::shifts of the water's light and of that on
    /// the surface.
    std::array<std::vector<float>, 2> water_shift, diffuse_shift;
    /// Standard errors by band (NodeLattice::find_errors): of the water's light, divided by the sum
    /// of the ray's IntervalWeights; and of the part of it that comes from indirect light on
    /// surfaces.
    std::vector<float> water_error, halo_error;
    SurfaceErrors surface_errors;
};

/// Calls visit(node) for a node and those within `radius` steps of it, in either direction.
template <class Visit>
void visit_around(const Grid2D<RadianceNode>& nodes, int i, int j, int radius, const Visit& visit) {
    for (int v = std::max(0, j - radius); v <= std::min(nodes.height() - 1, j + radius); ++v)
        for (int u = std::max(0, i - radius); u <= std::min(nodes.width() - 1, i + radius); ++u)
            visit(nodes(u, v));
}

/// Throws InputError if this many nodes, with the copies that smoothing makes, do not fit into free
/// memory. `groups`: see RadianceEstimator.
void require_room_for_nodes(std::size_t nodes, std::size_t intervals, std::size_t groups,
                            const LitScene& scene);

/// Smooths the nodes of a lattice: first the light on surfaces, over the nodes that see the same
/// surface; then, in a window, the light of the water, interval by interval, over the nodes whose
/// rays reach it. `groups`: see RadianceEstimator.
Grid2D<SmoothNode> smoothed_surfaces(const Grid2D<RadianceNode>& raw, std::size_t groups,
                                     std::size_t bands);
void smooth_water(const Grid2D<RadianceNode>& raw, const NodeWindow& window,
                  const DistanceIntervals& intervals, std::size_t groups, std::size_t bands,
                  Grid2D<SmoothNode>& nodes);

}  // namespace uw
