#pragma once

#include <array>
#include <vector>

#include "core/scene/geometry_desc.h"

namespace uw {

/// A straight edge in the world [m].
struct OutlineSegment {
    std::array<float, 3> from{}, to{};
};

/// Edges by which the shapes of a scene can be recognised in a plan: of meshes those at their rims
/// and where faces meet at more than 30 degrees; of boxes all; of spheres three great circles; of
/// planes, which have no end, none. The longest, if there are more than `most`. Meshes that cannot
/// be read have none: rendering reports that.
std::vector<OutlineSegment> scene_outlines(const std::vector<GeometryDesc>& geometry,
                                           std::size_t most = 20000);

}  // namespace uw
