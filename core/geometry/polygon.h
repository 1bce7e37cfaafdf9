#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace uw {

/// Splits one polygon into triangles by ear clipping, so that concave ones keep their outline, and
/// appends three vertex indices per triangle (corner count - 2 of them) to `triangles`. `corners`:
/// indices into `positions` (x, y, z each), all in range; fewer than three give nothing. Where a
/// polygon of up to 1000 corners crosses itself, the remainder becomes a fan. Time is proportional
/// to the number of corners: throws InputError "<name>: ..." for a polygon that would take longer,
/// and for a larger one that crosses itself.
void triangulate_polygon(std::span<const std::uint32_t> corners, std::span<const float> positions,
                         const std::string& name, std::vector<std::uint32_t>& triangles);

}  // namespace uw
