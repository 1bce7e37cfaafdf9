#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace uw {

/// Splits one polygon into triangles by ear clipping, so that concave ones keep their outline, and
/// appends three vertex indices per triangle (corner count - 2 of them) to `triangles`. `corners`:
/// indices into `positions` (x, y, z each), all in range; fewer than three give nothing. Polygons
/// of more than 1000 corners are split as a fan from the first corner, which is correct for convex
/// ones only: ear clipping would take quadratic time.
void triangulate_polygon(std::span<const std::uint32_t> corners, std::span<const float> positions,
                         std::vector<std::uint32_t>& triangles);

}  // namespace uw
