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
    /// Calls `change` with each plane of `from` and its own.
    template <class Change>
    void fill_from(const PathImage& from, const Change& change) {
        change(from.length_, length_);
        for (std::size_t k = 0; k < columns_.size(); ++k) change(from.columns_[k], columns_[k]);
    }

  private:
    ImagePlane length_;
    std::vector<ImagePlane> columns_;
};

/// Blurs images according to their pixels' paths, one band at a time (ForwardScatter). In water
/// that varies, a path is characterised by its blur length, int b/b_0 ds, and its optical depth:
/// both are linear in its columns.
class PathScatter {
  public:
    PathScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane, const Medium& medium)
        : PathScatter(ForwardScatter(desc, plane), medium, plane.width, plane.height) {}
    /// For light at the nodes of a grid; desc.K > 0.
    PathScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane, const Medium& medium,
                double spacing);

    /// Spreads the light of band `band` along its paths. Paths of dark pixels are not read.
    /// `means`: as ForwardScatter::add.
    void add(std::size_t band, const ImagePlane& light, const PathImage& paths, bool means = false);
    /// Writes the light that is added to the image by all that was spread, and resets to zero:
    /// ForwardScatter::finish and finish_pixels.
    void finish(ImagePlane& added) { scatter_.finish(added.values()); }
    void finish_pixels(ImagePlane& added) { scatter_.finish_pixels(added.values()); }

  private:
    PathScatter(ForwardScatter scatter, const Medium& medium, int width, int height);

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
