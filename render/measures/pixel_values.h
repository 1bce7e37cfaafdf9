#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <vector>

#include "core/base/spectrum.h"
#include "core/image/film.h"
#include "core/image/layers.h"

namespace uw {

/// One layer of a picture, perhaps of a single lamp: for pixel i (row by row) and band b the value
/// `gain[b] * values[i * stride + b]`. Lamps are mixed by their gains without being rendered again.
struct PicturePlane {
    std::span<const float> values;
    std::size_t stride = 0;
    Spectrum gain;
};

/// Those of `layers` that an image has, times `gain`. Refers to `film`.
std::vector<PicturePlane> layer_planes(const Film& film, const LayerPlan& plan,
                                       std::initializer_list<Layer> layers, double gain = 1);

/// The mean of a pixel's bands in a sum of layers.
class GreyLayers {
  public:
    /// `planes` outlive it.
    GreyLayers(const std::vector<PicturePlane>& planes, std::size_t bands)
        : planes_(planes), bands_(bands) {}

    bool empty() const { return planes_.empty(); }
    double at(std::size_t pixel) const {
        double sum = 0;
        for (const PicturePlane& plane : planes_)
            for (std::size_t b = 0; b < bands_; ++b)
                sum += plane.gain[b] * static_cast<double>(plane.values[pixel * plane.stride + b]);
        return sum / static_cast<double>(bands_);
    }

  private:
    const std::vector<PicturePlane>& planes_;
    std::size_t bands_;
};

/// 0 of no values.
double mean_of(std::span<const double> values);

/// The mean of the values between two shares of their number, from the least on; the value in the
/// middle of the two if there is none between them. Orders the values as it needs.
double mean_between(std::span<double> values, double low, double high);

/// The value below which a share of the values lies, between its neighbours. Orders the values as
/// it needs. Precondition: there are some.
double percentile(std::span<double> values, double share);

}  // namespace uw
