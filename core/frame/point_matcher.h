#pragma once

#include <limits>
#include <optional>
#include <span>

#include "core/surfaces/surfaces.h"

namespace uw {

/// Where a point that one image sees is in another.
struct PointMatch {
    /// Image position [pixels], perhaps outside the image; NaN where the camera cannot image it.
    double x = std::numeric_limits<double>::quiet_NaN();
    double y = std::numeric_limits<double>::quiet_NaN();
    bool is_occluded = true;  ///< hidden by a surface, or not within the image
};

/// Finds the surface points of one image in another of the scene: of another frame, or of another
/// camera. Thread safe.
class PointMatcher {
  public:
    virtual ~PointMatcher() = default;

    /// `matches[i]` is that of `hits[i]`, none for a point that has no counterpart; neighbours
    /// together cost less.
    virtual void match(std::span<const SurfaceHit* const> hits,
                       std::span<std::optional<PointMatch>> matches) const = 0;
};

/// Where a point is in other images, as far as they are asked for (PointMatchers).
struct PointMatches {
    std::optional<PointMatch> next, previous, other_camera;
};

/// The images in which the points of an image are looked for; null: not wanted, or there is none.
struct PointMatchers {
    const PointMatcher* next = nullptr;      ///< frame
    const PointMatcher* previous = nullptr;  ///< frame
    const PointMatcher* other_camera = nullptr;
    bool is_first_camera = true;  ///< whether this image is that of the pair's first camera
};

}  // namespace uw
