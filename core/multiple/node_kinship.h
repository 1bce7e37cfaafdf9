#pragma once

#include <cstddef>

#include "core/multiple/distance_intervals.h"
#include "core/multiple/multiple_nodes.h"

namespace uw {

/// The cosine of the largest angle between the normals at two places whose indirect light is
/// alike.
inline constexpr double k_least_node_cosine = 0.96;

/// Whether a node tells what light there is in the water of an interval: if enough of it lies
/// before the node's surface, and enough of its light arrives.
inline bool shows_interval(const MultipleNode& node, const DistanceIntervals& intervals,
                           std::size_t interval) {
    constexpr double k_least_share = 0.3;
    constexpr float k_least_weight = 1e-30F;
    return node.has_ray && node.mean_weights[interval] >= k_least_weight &&
           intervals.share(interval, 0, node.reach) >= k_least_share;
}

/// Whether two nodes tell of light on the same surface.
inline bool see_same_surface(const MultipleNode& a, const MultipleNode& b) {
    return a.surface && b.surface && a.surface->object_id == b.surface->object_id &&
           a.surface->is_glossy == b.surface->is_glossy &&
           glm::dot(a.surface->normal, b.surface->normal) >= k_least_node_cosine;
}

}  // namespace uw
