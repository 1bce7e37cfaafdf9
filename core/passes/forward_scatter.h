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

/// Approximates kernels of any width by those of a few widths: a kernel is a weighted sum of up to
/// four neighbours, by cubic interpolation in the logarithm of the width. Compared with the exact
/// kernel, it misplaces less than 0.25 % of the light.
class WidthLadder {
  public:
    /// A ladder without widths.
    WidthLadder() = default;
    /// Covers widths s from `least` to `greatest` [pixels], as BlurWidth. If these are equal, the
    /// only width is exactly this.
    WidthLadder(ForwardScatterDesc::Shape shape, double least, double greatest);

    const std::vector<double>& widths() const { return widths_; }

    /// Returns the position of a width on the ladder, in steps from the first width.
    double position(double width) const;
    /// Returns the interpolation weight of the kernel of width number `step` for the width at
    /// `position`; 0 unless the two are close.
    double weight(int step, double position) const {
        const int last = static_cast<int>(widths_.size()) - neighbours_;
        const int first = std::clamp(static_cast<int>(position - 0.5 * neighbours_) + 1, 0, last);
        const int n = step - first;
        if (n < 0 || n >= neighbours_) return 0;
        // The Lagrange polynomial that is 1 at the nth neighbour and 0 at the others.
        const double t = position - first;
        double value = inverse_[static_cast<std::size_t>(n)];
        for (int i = 0; i < neighbours_; ++i)
            if (i != n) value *= t - i;
        return value;
    }

  private:
    double offset_ = 0;
    double begin_ = 0, per_step_ = 1;            // of the logarithm of offset_ + width
    int neighbours_ = 1;                         // number of kernels in an interpolation
    std::array<double, 4> inverse_{1, 1, 1, 1};  // makes each polynomial 1 at its own node
    std::vector<double> widths_;
};

/// Throws InputError unless K >= 0, B >= 0 and |G| <= c for the attenuation c [1/m] of the uniform
/// water in every band: with G above c the factor e^{-GR} - e^{-cR} would be negative. `where`
/// prefixes the message.
void check_forward_scatter(const ForwardScatterDesc& desc, std::span<const double> attenuation,
                           const SourceLocation& where);

/// The image plane that is blurred.
struct ScatterPlane {
    int width = 0, height = 0;  // pixels
    /// Pixels per radian between rays in the water, near the optical axis: the focal length in
    /// pixels, times n_water / n_air behind a flat port.
    double focal_x = 0, focal_y = 0;
};

/// Light of one band and its paths through the water to the image plane, one value per pixel, row
/// by row. Where `light` is 0 (no ray, no surface), the path is not read and may be arbitrary.
struct ScatterSource {
    std::span<const float> light;        // radiance or irradiance, in any unit
    std::span<const float> blur_length;  // range R [m], or int b(s)/b_0 ds where the water varies
    /// Optical depth tau. Empty in uniform water: c_0 R.
    std::span<const float> optical_depth;
    double attenuation = 0;  // c_0 of the uniform water [1/m]
};

/// Blurs light by scattering forward through small angles (Wells 1973; physics section 6; the
/// paper's equations 14, 16, 17): each pixel's light L, at the range R, adds to the whole image
///
///     L K [e^{-GR} - e^{-cR}] F^-1{e^{-B R f}}
///
/// or the corresponding Gaussian. Where the water varies, R is the blur length, GR is (G/c_0) tau
/// and cR is tau. Every pixel spreads its own light with its own kernel, so that halos at depth
/// edges have the right width. The image is reflected at its border (MirroredBlur). Kernels are
/// interpolated between those of a few widths (WidthLadder), and a kernel is applied on a grid no
/// finer than it needs; the result is exact for a single range whose kernel is a few pixels wide.
///
/// Usage, one band at a time: add any number of sources (a single image of surfaces, or slab after
/// slab), then finish. Memory: two images of floats, and of doubles two at a time; none if K is 0.
class ForwardScatter {
  public:
    ForwardScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane);
    /// For smooth light that is given and returned only at the nodes of a grid, about `spacing` >=
    /// 1 pixels apart: MirroredBlur::add_nodes and finish_nodes.
    ForwardScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane, double spacing);

    /// Returns the maximum spacing [pixels] of nodes on which a kernel of width s = 1 pixel may be
    /// applied; it is proportional to s. The spectrum above the nodes' Nyquist frequency is below
    /// 0.2 %.
    static double nodes_per_width(ForwardScatterDesc::Shape shape);
    /// Returns the width s in pixels of the kernel for a blur length of 1 m; the smaller one if
    /// pixels are not square.
    static double width_per_metre(const ForwardScatterDesc& desc, const ScatterPlane& plane);

    /// The grid of the nodes. Precondition: constructed for nodes, K > 0.
    const SplineGrid& grid() const { return levels_.front()->grid(); }

    /// Spreads the light of one source; no effect if K is 0. At nodes, `means` says whether the
    /// light is a mean around each node. Throws std::invalid_argument if a size is wrong, or if a
    /// pixel's light or a lit pixel's path is negative or not finite; InputError as
    /// check_forward_scatter.
    void add(const ScatterSource& source, bool means = false);
    /// The same for light at a single `range` [m] in uniform water.
    void add(std::span<const float> light, double range, double attenuation);

    /// Writes the accumulated light, one value per pixel or node, and resets it to zero. The values
    /// are exactly zero if K is 0 or there was no light.
    void finish(std::span<float> added);
    /// The same with one value per pixel even if light is given at nodes.
    void finish_pixels(std::span<float> added);

  private:
    class Paths;
    void spread(std::span<const float> light, const Paths& paths, bool means);
    // Computes `given_` and `position_` for a ladder, which it returns; the ladder is empty if
    // there is no light.
    WidthLadder prepare_light(std::span<const float> light, const Paths& paths);
    MirroredBlur& level_for(double width);
    double max_width() const;

    ForwardScatterDesc desc_;
    ScatterPlane plane_;
    bool at_nodes_ = false;
    std::vector<std::optional<MirroredBlur>> levels_;  // by spacing; a single one at nodes
    Grid2D<float> given_, position_;  // light times its factor; position of its width on the ladder
};

}  // namespace uw
