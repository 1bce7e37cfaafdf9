#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace uw {

/// The result of a method for every pixel of a scene, row by row, one sample at each pixel's centre
/// [W m^-2 sr^-1]. Components that the method does not compute are empty.
struct MethodImage {
    std::vector<Spectrum> direct, backscatter;  // before forward scatter
    std::vector<Spectrum> forward;              // what forward scatter adds to `direct`
    std::vector<Spectrum> blurred_backscatter;  // with forward scatter
};

/// Resizes the image of `scene` to at most `longest_side` pixels a side, and makes it radiance in
/// the water, in which methods are compared.
void show_radiance_in_water(SceneDesc& scene, int longest_side);

/// A scene under test, assembled, with its lamps splatted.
struct TrialScene {
    Renderer renderer;

    const AssembledScene& scene() const { return renderer.assembled(); }
    const DeepShadows& light() const { return renderer.light(); }
    int width() const { return scene().camera->width(); }
    int height() const { return scene().camera->height(); }
};

/// Assembles `scene` and splats its lamps. This, and whatever is rendered of it, ends with
/// Interrupted if `proceed` returns false; likewise the two functions that follow.
TrialScene make_trial(const ResolvedScene& scene, const std::function<bool()>& proceed);

/// `trial` with its grids replaced by their mean over the field's bounds: uniform water, which
/// scatters forward with the scene's K, G and B. `scene` is what `trial` was made from.
TrialScene homogenised(const TrialScene& trial, const ResolvedScene& scene,
                       const std::function<bool()>& proceed);

/// `trial`, whose water is uniform, with a `share` of that water (above 0, at most 1) moved into a
/// VDB grid of constant value: the grid is written to a file and read back, and outside it is only
/// the rest. It extends from all cameras, lamps and surfaces as far as 15 optical depths. G and B
/// of forward scatter are relative to the uniform water that they describe (physics section 6): if
/// some of it stays, they are reduced with it, so that the blur is the same.
TrialScene with_constant_grid(const TrialScene& trial, const ResolvedScene& scene, double share,
                              const std::function<bool()>& proceed);

/// `count` of McGlamery's planes in the water of `trial`, placed as its scene says.
Slabs planes_of(const TrialScene& trial, int count);

/// Renders every pixel by `transport` before forward scatter. Throws Interrupted if `proceed`
/// returns false.
MethodImage render_method(const TrialScene& trial, const LightTransport& transport,
                          const std::function<bool()>& proceed);

/// Likewise with forward scatter, as `uwvdb render` does it: fills the other two components of
/// `image`.
void render_forward_scatter(TrialScene& trial, const LightTransport& transport, MethodImage& image);

/// Pixels whose water ray meets no shadow edge and no hard edge of a lamp's beam, row by row: where
/// a sum over slabs converges with the square of their thickness.
std::vector<char> smooth_pixels(const TrialScene& trial);

}  // namespace uw
