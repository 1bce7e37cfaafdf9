#pragma once

#include <array>

#include "core/base/grid2d.h"
#include "core/image/film.h"

namespace uw {

/// A linear map of the plane: a column is where it takes an axis.
struct PlaneMap {
    double xx = 0, yx = 0;  // first column
    double xy = 0, yy = 0;  // second

    double determinant() const { return xx * yy - xy * yx; }
    PlaneMap inverse() const {
        const double d = determinant();
        return {yy / d, -yx / d, -xy / d, xx / d};
    }
    friend PlaneMap operator*(double a, const PlaneMap& m) {
        return {a * m.xx, a * m.yx, a * m.xy, a * m.yy};
    }
    friend PlaneMap operator*(const PlaneMap& a, const PlaneMap& b) {
        return {a.xx * b.xx + a.xy * b.yx, a.yx * b.xx + a.yy * b.yx, a.xx * b.xy + a.xy * b.yy,
                a.yx * b.xy + a.yy * b.yy};
    }
};

/// What an image shows of a small sphere: its disk, blurred by the lens's aperture, which is an
/// ellipse, and drawn out by what moves while the shutter is open [pixels].
class Footprint {
  public:
    /// The position over the time that the shutter is open, t = -1 to 1: at + t linear + t^2
    /// quadratic.
    struct Path {
        std::array<double, 2> at{}, linear{}, quadratic{};
    };

    /// `disk` and `blur` take the unit disk to what the sphere and a point out of focus look like;
    /// a blur of 0 is a sharp image.
    Footprint(const Path& path, const PlaneMap& disk, const PlaneMap& blur);

    /// The area of the sphere's disk [pixels].
    double area() const { return area_; }
    /// The pixels that it touches, wherever the image ends.
    const PixelWindow& bounds() const { return bounds_; }

    /// Adds to each pixel of `window` the share of the footprint that falls into it, to
    /// shares(x - window.x0, y - window.y0); they add up to 1 over all pixels of the plane.
    void add_shares(const PixelWindow& window, Grid2D<double>& shares) const;

  private:
    std::array<double, 2> position(double t) const;
    std::array<double, 2> step_position(int step) const;
    void add_box(const std::array<double, 2>& at, const std::array<double, 2>& half, double weight,
                 const PixelWindow& window, Grid2D<double>& shares) const;
    void add_ellipse(const std::array<double, 2>& at, double weight, const PixelWindow& window,
                     Grid2D<double>& shares) const;
    // How many samples of each pixel an ellipse holds; returns their sum.
    double count_samples(const std::array<double, 2>& at, const PixelWindow& window,
                         Grid2D<double>& counts) const;
    PixelWindow window_around(const std::array<double, 2>& at) const;

    Path path_;
    double area_ = 0;
    bool is_small_ = false;         // drawn as a box of the same extent
    int steps_ = 1;                 // positions along the path
    std::array<double, 2> half_{};  // of the box; of the box around the ellipse
    PlaneMap unit_from_plane_;      // of the greater of disk and blur
    double ratio_ = 0;              // of the lesser to it
    int samples_ = 1;               // along each axis of a pixel
    double scale_ = 1;              // of the shares of an ellipse
    bool is_scaled_ = true;         // by scale_; else so that they add up to 1
    PixelWindow bounds_;
};

}  // namespace uw
