#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/affine.h"

namespace uw {

/// A span of time, relative to that of a frame [s].
struct TimeSpan {
    double begin = 0, end = 0;

    double middle() const { return 0.5 * (begin + end); }
    double length() const { return end - begin; }
};

/// When the rows of an image are exposed. With a rolling shutter one row follows the other; the
/// middle of the image's height is exposed around the frame's time.
struct RowExposure {
    double shutter = 0;    ///< exposure time of a row [s]
    double line_time = 0;  ///< from row to row [s]
    int height = 0;        ///< rows
    /// Only what is exposed within this counts: a part of the exposure. Rows that are not exposed
    /// then have its nearest end.
    TimeSpan part{-k_always, k_always};

    /// The middle of the exposure at image row `y` [pixels], all of it.
    double middle(double y) const { return (y - 0.5 * height) * line_time; }
    /// Of a row, within the part.
    TimeSpan at(double y) const {
        const double t = middle(y);
        return {std::clamp(t - 0.5 * shutter, part.begin, part.end),
                std::clamp(t + 0.5 * shutter, part.begin, part.end)};
    }
    /// That of the whole image, whatever the part.
    TimeSpan all() const { return {middle(0) - 0.5 * shutter, middle(height) + 0.5 * shutter}; }
    /// The share of the exposure of pixel row `row` that lies within the part.
    double share(int row) const {
        const double t = middle(row + 0.5);
        if (shutter > 0) return at(row + 0.5).length() / shutter;
        return t >= part.begin && t < part.end ? 1 : 0;
    }

  private:
    static constexpr double k_always = 1e30;
};

/// How a camera moves around the time of its frame.
class CameraMotion {
  public:
    /// `world_from_camera`: poses at equal intervals over `span`, both ends included, two or more;
    /// between them positions and axes are interpolated linearly.
    CameraMotion(std::vector<Affine> world_from_camera, const TimeSpan& span)
        : poses_(std::move(world_from_camera)), span_(span) {}

    /// The pose at a time relative to the frame's; outside of the span, that of its nearest end.
    Affine at(double time) const;

  private:
    std::vector<Affine> poses_;
    TimeSpan span_;
};

}  // namespace uw
