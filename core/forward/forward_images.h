#pragma once

#include <vector>

#include "core/base/grid2d.h"
#include "core/forward/forward_scatter.h"
#include "core/forward/in_scatter_slabs.h"
#include "core/optics/medium.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// One value per pixel.
using ImagePlane = Grid2D<float>;

/// A path through the water for every pixel.
class PathImage {
  public:
    PathImage() = default;
    PathImage(int width, int height, std::size_t constituents)
        : length_(width, height), columns_(constituents, ImagePlane(width, height)) {}

    void set(std::size_t pixel, const WaterPath& path) {
        length_[pixel] = static_cast<float>(path.length);
        for (std::size_t k = 0; k < columns_.size(); ++k)
            columns_[k][pixel] = static_cast<float>(path.columns[k]);
    }
    const ImagePlane& length() const { return length_; }
    const ImagePlane& column(std::size_t constituent) const { return columns_[constituent]; }

  private:
    ImagePlane length_;
    std::vector<ImagePlane> columns_;
};

/// Blurs images according to their pixels' paths, one band at a time (ForwardScatter). In water
/// that varies, a path is characterised by its blur length, int b/b_0 ds, and its optical depth:
/// both are linear in its columns.
class PathScatter {
  public:
    PathScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane, const Medium& medium);

    /// Writes into `added` the light of band `band` that is added to the image when each pixel's
    /// light is scattered along its path. Paths of dark pixels are not read.
    void operator()(std::size_t band, const ImagePlane& light, const PathImage& paths,
                    ImagePlane& added);

  private:
    ForwardScatter scatter_;
    AttenuationTable attenuation_;
    Spectrum uniform_b_{};                 // b_0 [1/m]
    std::vector<Spectrum> constituent_b_;  // [1/m per unit]
    ImagePlane blur_length_, optical_depth_;
};

/// Throws InputError at `where` unless blur lengths are defined in `medium`: water that varies
/// needs a uniform part that scatters.
void check_blur_length(const Medium& medium, const SourceLocation& where);

}  // namespace uw
