#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/base/grid2d.h"
#include "core/passes/mirrored_blur.h"
#include "core/scene/water_desc.h"

namespace uw {

/// A few widths between which kernels are interpolated: the kernel of any width from the least to
/// the greatest is a sum of those of up to four neighbouring widths, by a cubic in the logarithm.
/// Compared with the exact kernel it misplaces less than 0.25 % of the light.
class WidthLadder {
  public:
    /// No widths.
    WidthLadder() = default;
    /// For widths s from `least` to `greatest` [pixels], as BlurWidth. If they are the same, the
    /// only width is exactly this.
    WidthLadder(ForwardScatterDesc::Shape shape, double least, double greatest);

    const std::vector<double>& widths() const { return widths_; }

    /// The place of a width on the ladder: 0 for the first, counted in steps.
    double place(double width) const;
    /// The share of the kernel of width `step` in that of the width at `place`; 0 unless `place` is
    /// close.
    double weight(int step, double place) const {
        const int last = static_cast<int>(widths_.size()) - neighbours_;
        const int first = std::clamp(static_cast<int>(place - 0.5 * neighbours_) + 1, 0, last);
        const int n = step - first;
        if (n < 0 || n >= neighbours_) return 0;
        // Lagrange's polynomial that is 1 at the nth of the neighbours, and 0 at the others.
        const double t = place - first;
        double value = inverse_[static_cast<std::size_t>(n)];
        for (int i = 0; i < neighbours_; ++i)
            if (i != n) value *= t - i;
        return value;
    }

  private:
    double offset_ = 0;
    double begin_ = 0, per_step_ = 1;            // of the logarithm
    int neighbours_ = 1;                         // in an interpolation
    std::array<double, 4> inverse_{1, 1, 1, 1};  // of each polynomial's value at its own node
    std::vector<double> widths_;
};

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
/// interpolated between those of a few widths (WidthLadder), and a kernel is applied on a grid no
/// finer than it needs; a single range of a few pixels' width is exact.
///
/// Usage, one band at a time: add any number of sources (a single image of surfaces, or slab after
/// slab), then finish. Memory: two images of floats, and of doubles two at a time; none if K is 0.
class ForwardScatter {
  public:
    ForwardScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane);
    /// For smooth light, given and returned at the nodes of a grid of about `spacing` >= 1 pixels
    /// alone: MirroredBlur::add_nodes and finish_nodes.
    ForwardScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane, double spacing);

    /// The greatest distance [pixels] of nodes that a kernel of width s = 1 pixel may be applied
    /// on, in proportion to s: what its spectrum has beyond them is below 0.2 %.
    static double nodes_per_width(ForwardScatterDesc::Shape shape);
    /// Width s in pixels of the kernel for a blur length of 1 m; the smaller one if pixels are not
    /// square.
    static double width_per_metre(const ForwardScatterDesc& desc, const ScatterPlane& plane);

    /// The grid of the nodes. Precondition: made for nodes, K > 0.
    const SplineGrid& grid() const { return levels_.front()->grid(); }

    /// Spreads one source's light; no effect if K is 0. At nodes, `means` says whether light is a
    /// mean about each. Throws std::invalid_argument if a size is wrong, or if a pixel's light or a
    /// lit pixel's path is negative or not finite; InputError as check_forward_scatter.
    void add(const ScatterSource& source, bool means = false);
    /// The same with all of `light` seen over one `range` [m] in uniform water.
    void add(std::span<const float> light, double range, double attenuation);

    /// Writes the accumulated light, one value per pixel, and resets to zero. The values are
    /// exactly zero if K is 0 or there was no light.
    void finish(std::span<float> added);
    /// The same for one value per pixel where light is given at nodes.
    void finish_pixels(std::span<float> added);

  private:
    class Paths;
    void spread(std::span<const float> light, const Paths& paths, bool means);
    // Computes `given_` and `place_` on a ladder, which is empty if there is no light.
    WidthLadder place_light(std::span<const float> light, const Paths& paths);
    MirroredBlur& level_for(double width);
    double widest() const;

    ForwardScatterDesc desc_;
    ScatterPlane plane_;
    bool at_nodes_ = false;
    std::vector<std::optional<MirroredBlur>> levels_;  // at nodes a single one
    Grid2D<float> given_, place_;  // light times its factor, and its width's place on the ladder
};

}  // namespace uw
