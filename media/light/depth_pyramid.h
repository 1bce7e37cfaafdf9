#pragma once

#include <cstddef>
#include <vector>

#include "core/base/grid2d.h"

namespace uw {

/// The depths of surfaces within a part of a shadow map.
struct DepthRange {
    float nearest;
    float farthest;
};

/// Least and greatest depth over the cells of a shadow map, and over squares of 2, 4, 8... of them.
class DepthPyramid {
  public:
    /// A depth that was not traced.
    static constexpr float k_untraced = -1;

    DepthPyramid() = default;
    /// `samples`: the depths at the corners of the cells, as many across as down, infinite where
    /// there is nothing; a cell without a traced corner has no bounds (bound).
    explicit DepthPyramid(const Grid2D<float>& samples);

    bool empty() const { return levels_.empty(); }
    /// Over the cells from (u0, v0) to (u1, v1), and perhaps some around them.
    DepthRange bound(int u0, int v0, int u1, int v1) const;
    std::size_t bytes() const;

  private:
    using Level = Grid2D<DepthRange>;

    static Level cell_ranges(const Grid2D<float>& samples);
    static Level halved(const Level& fine);

    std::vector<Level> levels_;
};

}  // namespace uw
