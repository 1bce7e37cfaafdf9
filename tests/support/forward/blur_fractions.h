#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/scene/water_desc.h"

namespace uw::test {

/// F^-1{e^{-2 pi s f}} at distance r, or the Gaussian of sigma = sqrt(2) s: density per pixel^2.
inline double blur_density(ForwardScatterDesc::Shape shape, double s, double r) {
    if (shape == ForwardScatterDesc::Shape::exponential)
        return s / (2 * std::numbers::pi * std::pow(s * s + r * r, 1.5));
    const double variance = 2 * s * s;
    return std::exp(-0.5 * r * r / variance) / (2 * std::numbers::pi * variance);
}

/// Integral of blur_density over [0, x] x [0, y] in closed form: the exponential's is the solid
/// angle of the rectangle seen from height s, over 2 pi.
inline double blur_in_corner(ForwardScatterDesc::Shape shape, double s, double x, double y) {
    if (shape == ForwardScatterDesc::Shape::exponential)
        return std::atan2(x * y, s * std::sqrt(s * s + x * x + y * y)) / (2 * std::numbers::pi);
    return std::erf(x / (2 * s)) * std::erf(y / (2 * s)) / 4;
}

/// Fractions of a pixel's light that land in the pixels at offsets 0..reach in either direction.
class BlurFractions {
  public:
    BlurFractions(ForwardScatterDesc::Shape shape, double s, int reach)
        : reach_(reach), side_(static_cast<std::size_t>(reach) + 1), fractions_(side_ * side_) {
        const auto corner = [&](double x, double y) { return blur_in_corner(shape, s, x, y); };
        double inside = 0;
        for (int j = 0; j <= reach; ++j) {
            for (int i = 0; i <= reach; ++i) {
                const double fraction = corner(i + 0.5, j + 0.5) - corner(i - 0.5, j + 0.5) -
                                        corner(i + 0.5, j - 0.5) + corner(i - 0.5, j - 0.5);
                fractions_[index(i, j)] = fraction;
                inside += (i > 0 ? 2 : 1) * (j > 0 ? 2 : 1) * fraction;
            }
        }
        outside_ = 1 - inside;
    }

    /// The fraction of a pixel at (x0, y0) that lands in (x, y) of a width x height image whose
    /// scene is mirrored at its borders: that of all its mirror images. What lies beyond the reach
    /// is spread evenly.
    double mirrored(int x0, int y0, int x, int y, int width, int height) const {
        double sum = outside_ / (width * height);
        for (int v : {y0, -1 - y0}) {
            for (int b = nearest(v - y, height); std::abs(b) <= reach_; b += 2 * height)
                for (int u : {x0, -1 - x0})
                    for (int a = nearest(u - x, width); std::abs(a) <= reach_; a += 2 * width)
                        sum += fractions_[index(std::abs(a), std::abs(b))];
        }
        return sum;
    }

  private:
    std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(j) * side_ + static_cast<std::size_t>(i);
    }
    // The least of offset + 2 n side that is no less than -reach.
    int nearest(int offset, int side) const {
        const int period = 2 * side;
        const int above = ((offset + reach_) % period + period) % period;
        return above - reach_;
    }

    int reach_;
    std::size_t side_;
    std::vector<double> fractions_;
    double outside_ = 0;
};

}  // namespace uw::test
