#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/forward/mirrored_blur.h"
#include "core/scene/forward_scatter_desc.h"
#include "core/scene/source_location.h"

namespace uw {

/// Throws InputError unless K >= 0, B >= 0 and |G| <= c for the attenuation c [1/m] of the uniform
/// water in every band: with G above c the factor e^{-GR} - e^{-cR} would be negative. `where`
/// prefixes the message.
void check_forward_scatter(const ForwardScatterDesc& desc, std::span<const double> attenuation,
                           const SourceLocation& where);

/// The image plane on which the blur appears.
struct ScatterPlane {
    int width = 0, height = 0;  // pixels
    /// Pixels per radian between rays in the water, about the optical axis: the focal length in
    /// pixels, times n_water / n_air behind a flat port.
    double focal_x = 0, focal_y = 0;
};

/// Light of one band, and the water between it and the image plane, one value per pixel, row by
/// row. Where `light` is 0 (no ray, no surface) the water is not read and may be arbitrary.
struct ScatterSource {
    std::span<const float> light;        // to be blurred: radiance or irradiance, any unit
    std::span<const float> blur_length;  // range R [m], or int b(s)/b_0 ds where the water varies
    /// Optical depth tau. Empty in uniform water: c_0 R.
    std::span<const float> optical_depth;
    double attenuation = 0;  // c_0 of the uniform water [1/m]
};

/// Light scattered forward through small angles (physics section 6; the paper's equations 14, 16,
/// 17): each pixel's light L, seen over the range R, adds to the whole image
///
///     L K [e^{-GR} - e^{-cR}] F^-1{e^{-B R f}}
///
/// or the corresponding Gaussian. Where the water varies, R is the blur length, GR is (G/c_0) tau
/// and cR is tau. Every pixel spreads its own light with its own kernel, so depth edges have no
/// halo of the wrong width; the image is reflected at its border (MirroredBlur). Kernels are
/// interpolated linearly in R between neighbouring widths of a ladder, which misplaces less than
/// 0.25 % of the light; a single range is exact.
///
/// Usage, one band at a time: add any number of sources (a single image of surfaces, or slab after
/// slab), then finish. Memory: two images of doubles, none if K is 0.
class ForwardScatter {
  public:
    ForwardScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane);

    /// Spreads one source's light; no effect if K is 0. Throws std::invalid_argument if a size is
    /// wrong, or if a pixel's light or a lit pixel's path is negative or not finite; InputError as
    /// check_forward_scatter.
    void add(const ScatterSource& source);
    /// The same with all of `light` seen over one `range` [m] in uniform water.
    void add(std::span<const float> light, double range, double attenuation);

    /// Writes the accumulated light, one value per pixel, and resets to zero. The values are
    /// exactly zero if K is 0 or there was no light.
    void finish(std::span<float> added);

  private:
    class Paths;
    struct Extent;
    void spread(std::span<const float> light, const Paths& paths);
    std::vector<double> ladder(const Extent& lengths) const;
    BlurKernel kernel(double length) const;

    ForwardScatterDesc desc_;
    ScatterPlane plane_;
    std::optional<MirroredBlur> sum_;  // empty if K is 0
};

}  // namespace uw
