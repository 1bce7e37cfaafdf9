#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/base/spectrum.h"
#include "render/renderer.h"
#include "render/validation/validation.h"

namespace uw {

/// Changes the light transport under test: tests make it wrong, to show that it is found.
using TransportChange = std::function<LightTransport(LightTransport honest)>;

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

/// Assembles `scene` and splats its lamps. Throws Interrupted, as all that follows.
TrialScene make_trial(const ImageScene& scene);

/// `trial` with its grids replaced by their mean over the field's bounds: uniform water, which
/// scatters forward with the scene's K, G and B. `scene` is what `trial` was made from.
TrialScene homogenised(const TrialScene& trial, const ImageScene& scene);

/// `trial`, whose water is uniform, with a `fraction` of that water (above 0, at most 1) moved into
/// a VDB grid of constant value: the grid is written to a file and read back, and outside it is
/// only the rest. It extends from all cameras, lamps and surfaces as far as 15 optical depths. G
/// and B of forward scatter are relative to the uniform water that they describe (physics section
/// 6): if some of it stays, they are reduced with it, so that the blur is the same.
TrialScene with_constant_grid(const TrialScene& trial, const ImageScene& scene, double fraction);

/// `count` of McGlamery's planes in the water of `trial`, placed as its scene says.
Slabs planes_of(const TrialScene& trial, int count);

/// Renders every pixel by `transport` before forward scatter.
MethodImage render_method(const TrialScene& trial, const LightTransport& transport);

/// Renders it with forward scatter, as `uwvdb render` does it: fills the other two components of
/// `image`.
void render_forward_scatter(TrialScene& trial, const LightTransport& transport, MethodImage& image);

/// Pixels whose water ray meets no shadow edge and no hard edge of a lamp's beam, row by row: where
/// a sum over slabs converges with the square of their thickness.
std::vector<char> smooth_pixels(const TrialScene& trial);

/// Pixels darker than this fraction of the mean are compared with that, where nothing else is said.
inline constexpr double k_dark = 0.01;

/// The mean of one band.
double mean_over_pixels(const std::vector<Spectrum>& image, std::size_t band);

/// The largest difference of `a` relative to `b` over the pixels that `counted` marks; those darker
/// than the fraction `dark` of b's mean count as that bright.
double max_difference(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b,
                      const std::vector<char>& counted, std::size_t band, double dark);

/// The RMS of the differences, relative to b's mean.
double rms_difference(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b,
                      std::size_t band);

/// McGlamery's sums of backscatter over ever more slabs of uniform water.
struct PlaneSums {
    MethodImage limit;            // of infinitely many slabs
    MethodImage finest, coarser;  // the sum over the most slabs, and that over half as many
    std::vector<PlanesStep> steps;
};

struct PlaneSumOptions {
    double tolerance;  // sums are refined while they change by more [relative]
    int max_planes;    // slabs of the finest sum, and more where it is still rough
    std::function<void(const std::string&)> say;  // gets the name of each sum
};

/// Doubles the number of slabs until the largest change over the pixels that `smooth` marks is
/// within the tolerance, and at least up to `max_planes`; beyond that not for more than some 20
/// seconds. The midpoint rule's error falls with the square of the thickness, so the limit is
/// (4 fine - coarse) / 3 (Richardson); where a shadow's edge crosses the ray it falls with the
/// thickness only, and the limit may be off by as much as the last two sums differ.
PlaneSums sum_planes_to_limit(const TrialScene& uniform, const std::vector<char>& smooth,
                              const PlaneSumOptions& options);

/// The name of the sum over `count` slabs.
std::string planes_name(int count);

/// Forward scatter of the light of surfaces (physics section 6; the paper's equations 14 and 16) in
/// uniform water, written out as a sum over all pairs of pixels: every pixel's light times the
/// closed form of its own kernel over every other pixel and its mirror images at the borders. No
/// transforms, no interpolated kernel widths, no float: shares nothing with ForwardScatterPass but
/// the focal lengths in the water. Surfaces are lit by `lighting`. Cost: pixels^2.
std::vector<Spectrum> forward_by_direct_sum(const TrialScene& trial,
                                            const SurfaceLighting& lighting);

}  // namespace uw
