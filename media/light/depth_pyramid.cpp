#include "media/light/depth_pyramid.h"

#include <algorithm>
#include <limits>

namespace uw {

namespace {

constexpr float k_nothing = std::numeric_limits<float>::infinity();

}  // namespace

DepthPyramid::DepthPyramid(const Grid2D<float>& samples) {
    levels_.push_back(cell_ranges(samples));
    while (levels_.back().width() > 1) levels_.push_back(halved(levels_.back()));
}

// Four samples bound the depths of a plane between them: from a point 1 / depth is linear over it,
// along parallel rays depth is.
DepthPyramid::Level DepthPyramid::cell_ranges(const Grid2D<float>& samples) {
    const int n = samples.width() - 1;
    Level level(n, n);
    for (int v = 0; v < n; ++v) {
        const float* const above = samples.row(v).data();
        const float* const below = samples.row(v + 1).data();
        DepthRange* const cells = level.row(v).data();
        for (int u = 0; u < n; ++u) {
            const float nearest = std::min({above[u], above[u + 1], below[u], below[u + 1]});
            // Cells outside the beam have no bounds.
            cells[u] = nearest == k_untraced
                           ? DepthRange{k_nothing, 0}
                           : DepthRange{nearest,
                                        std::max({above[u], above[u + 1], below[u], below[u + 1]})};
        }
    }
    return level;
}

DepthPyramid::Level DepthPyramid::halved(const Level& fine) {
    const int size = (fine.width() + 1) / 2, last = fine.width() - 1;
    Level coarse(size, size);
    for (int v = 0; v < size; ++v) {
        const DepthRange* const above = fine.row(2 * v).data();
        const DepthRange* const below = fine.row(std::min(2 * v + 1, last)).data();
        DepthRange* const cells = coarse.row(v).data();
        for (int u = 0; u < size; ++u) {
            const int left = 2 * u, right = std::min(2 * u + 1, last);
            cells[u] = {std::min({above[left].nearest, above[right].nearest, below[left].nearest,
                                  below[right].nearest}),
                        std::max({above[left].farthest, above[right].farthest, below[left].farthest,
                                  below[right].farthest})};
        }
    }
    return coarse;
}

DepthRange DepthPyramid::bound(int u0, int v0, int u1, int v1) const {
    std::size_t level = 0;
    while (u1 - u0 > 1 || v1 - v0 > 1) {
        u0 /= 2, u1 /= 2, v0 /= 2, v1 /= 2;
        ++level;
    }
    const Level& cells = levels_[level];
    DepthRange range{k_nothing, 0};
    for (int v = v0; v <= v1; ++v) {
        for (int u = u0; u <= u1; ++u) {
            const DepthRange& cell = cells(u, v);
            range.nearest = std::min(range.nearest, cell.nearest);
            range.farthest = std::max(range.farthest, cell.farthest);
        }
    }
    return range;
}

std::size_t DepthPyramid::bytes() const {
    std::size_t total = 0;
    for (const Level& level : levels_) total += level.size() * sizeof(DepthRange);
    return total;
}

}  // namespace uw
