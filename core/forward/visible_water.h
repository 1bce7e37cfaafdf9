#pragma once

#include <array>
#include <limits>

#include "core/forward/forward_images.h"
#include "core/frame/pixel_view.h"
#include "core/integrators/slabs.h"

namespace uw {

/// How far each pixel sees into the water, by camera z or whatever slabs are placed by. Where a
/// pixel's samples end on surfaces at several depths, those in front and those behind the widest
/// gap are each taken together.
class VisibleWater {
  public:
    VisibleWater() = default;
    VisibleWater(int width, int height) : share_(width, height) {
        for (ImagePlane& depth : depths_) depth.assign(width, height);
    }

    /// Stores a pixel; `depth` is that along its ray. Callable from any thread, once per pixel;
    /// pixels that are not stored have no water.
    void set(std::size_t pixel, const PixelView& view, const RayDepth& depth);

    /// The fraction of a pixel whose water begins, and that sees beyond `z`.
    double alpha(std::size_t pixel) const {
        return static_cast<double>(share_[pixel][0]) + static_cast<double>(share_[pixel][1]);
    }
    double beyond(std::size_t pixel, double z) const {
        double sum = 0;
        for_each(pixel, [&](double share, double end) {
            if (end > z) sum += share;
        });
        return sum;
    }
    /// Calls `body(share, end)` for the parts of a pixel.
    template <class Body>
    void for_each(std::size_t pixel, const Body& body) const {
        for (std::size_t n = 0; n < 2; ++n)
            if (share_[pixel][n] > 0)
                body(static_cast<double>(share_[pixel][n]), static_cast<double>(depths_[n][pixel]));
    }
    /// Where the pixel's water ends, 0 without any.
    double end(std::size_t pixel) const {
        return static_cast<double>(depths_[share_[pixel][1] > 0 ? 1 : 0][pixel]);
    }
    std::size_t size() const { return share_.size(); }
    int width() const { return share_.width(); }
    int height() const { return share_.height(); }

    /// The least and the greatest depth of all pixels; the least is -infinity if a pixel does not
    /// see any water with all of its samples.
    struct Extent {
        double nearest = std::numeric_limits<double>::infinity();
        double farthest = 0;
    };
    Extent extent() const;

  private:
    Grid2D<std::array<float, 2>> share_;
    std::array<ImagePlane, 2> depths_;  // near, far
};

}  // namespace uw
