#pragma once

#include <optional>
#include <string>

#include "core/base/vec.h"
#include "media/vdb/vdb_header.h"

namespace uw {

/// What can be told of a cache that Blender's fluid solver has baked with Adaptive Domain. Each
/// frame then has a grid of its own, cut out of the domain around the smoke, and the voxel size
/// stored with it is the domain's longest side divided by the longest side of that cut, not by the
/// domain's resolution: it is too large, by a different factor in every frame. The true size, and
/// where the cut lies, are in the cache's folder config alone (fluid_config.h).
struct AdaptiveDomain {
    double longest_side = 0;  // of the whole domain [m]
    int most_voxels = 0;      // of any frame looked at: the domain has at least as many along it
    std::optional<double> voxel;  // the true size [m], if it is known
    Vector3 first{0};             // voxel of the domain at which the grid begins; 0 if not known

    /// The voxel size can be no larger [m].
    double largest_voxel() const { return longest_side / most_voxels; }
    /// What it is and what to do, to follow "...: ".
    std::string description() const;
};

/// Recognises a frame of such a cache by its configuration or, without one, by comparing it with
/// others of its sequence, which lie beside it and differ in their number: up to eight of them, by
/// their headers. Empty if it is no such cache, or if nothing tells.
std::optional<AdaptiveDomain> find_adaptive_domain(const VdbHeader& header);

}  // namespace uw
