#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/surfaces/surfaces.h"
#include "media/light/depth_pyramid.h"
#include "media/light/light_frame.h"

namespace uw {

/// Visibility of a sun: what a ShadowMap is for a lamp, with parallel rays over squares across the
/// light, the finest of which decides. Outside them, where only endless surfaces cast shadows,
/// exact shadow rays look for their edges. What lies above the water's surface casts none.
class SunShadowMap {
  public:
    /// Traces `resolution`^2 rays in each of `squares`, which lie within each other, the smallest
    /// first. `surfaces` must outlive the map.
    SunShadowMap(const Surfaces& surfaces, const Sunlight& sun,
                 std::span<const LightSquare> squares, int resolution);

    /// The squares with which everything near `centre` is resolved best: the largest holds all
    /// finite surfaces, but reaches no farther than `reach` from `centre` [m], and each other is a
    /// quarter of the next as wide and lies around `centre`, which may move within it a little
    /// before it follows. None without finite surfaces.
    static std::vector<LightSquare> squares_around(const Point3& centre, double reach,
                                                   const Bounds& surfaces, const Sunlight& sun);

    /// As DeepShadow::lit_intervals. Edges are accurate to 3e-5 of the stretch; a shadow narrower
    /// than a texel may be missed.
    void lit_intervals(const Ray& ray, const Interval& stretch, std::vector<Interval>& lit) const;

    std::uint64_t rays_traced() const { return rays_traced_; }
    std::size_t bytes() const;

  private:
    struct Level {
        LightSquare square;
        double first_depth = 0;  // from which depths count
        DepthPyramid depths;
    };
    class Search;

    void trace(const LightSquare& square);

    const Surfaces* surfaces_;
    LightFrame frame_;
    int resolution_;
    std::vector<Level> levels_;
    std::uint64_t rays_traced_ = 0;
};

}  // namespace uw
