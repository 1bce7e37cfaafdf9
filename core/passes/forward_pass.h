#pragma once

#include <functional>
#include <vector>

#include "core/image/colour.h"
#include "core/image/film.h"
#include "core/image/image_quantity.h"
#include "core/image/layers.h"
#include "core/passes/forward_images.h"
#include "core/passes/pixel_pass.h"
#include "core/passes/pixel_renderer.h"

namespace uw {

/// The parameters of a scene's forward scatter.
struct ForwardScatterSetup {
    ForwardScatterDesc desc;  // K > 0
    ScatterPlane plane;       // the whole image
    /// Camera z of the boundaries between the slabs that the water is split into [m], ascending.
    std::vector<double> faces;
    bool shells = false;  // `faces` and `first` are distances along water rays instead
    Interval first;       // camera z range of `backscatter_first`; both ends are among `faces`
    /// Pixels between the nodes at which in-scatter is integrated, >= 1.
    double spacing = 1;
    LampPaths::PointColumn lamp_column;
    SensorModel sensor;  // the renderer's
    bool has_snow = false;
};

/// Forward scatter of a rendered image in the paper's four places (physics section 6), a second
/// pass over the pixels:
///
///     (14)  E     = E' + E' * g(R_lamps)      light falling on surfaces
///     (16)  L_s   = L_d + L_d * g(R_c)        the signal, with (14) in it
///     (17)  E_s   = E_s' + E_s' * g(R_lamps)  light scattered to the camera by a slab of water
///     (18)  L_b   = sum_i L_i + L_i * g(R_i)  each slab's light on its way to the camera,
///                                             with (17) in it
///
/// The light added by (14) and (16) is the layer `forward`; that added by (17) and (18) belongs to
/// `backscatter`. The blur acts on radiance in water, and the factor (PixelResult::pixel_factor) of
/// the pixel where it lands is applied afterwards; in the paper's output, (16) and (18) blur light
/// that carries the factor of the pixel it comes from. Slabs are processed a few at a time, so
/// memory does not grow with their number. The result does not depend on the number of threads.
class ForwardPass {
  public:
    /// All references must outlive the pass. Throws InputError if there is not enough memory.
    ForwardPass(const PixelRenderer& renderer, const LitScene& scene,
                const ForwardScatterSetup& setup, const LayerPlan& plan);

    /// Stores what the second pass needs of pixel (x, y). Callable from any thread.
    void keep(int x, int y, const RenderedPixel& pixel);

    /// Scatters everything stored. Throws Interrupted if `progress` returned false.
    void run(const ProgressCallback& progress);

    /// Adds the result to a film that holds the first pass and whose window is the whole image.
    void write(const LayerPlan& plan, const BandColour& colour, Film& film) const;

  private:
    /// The light of a lamp whose layer is requested; the first has that of all others.
    struct Group {
        std::vector<std::size_t> lamps;
        std::vector<ImagePlane> direct;   // per band
        std::vector<ImagePlane> forward;  // per band; irradiance until (14) has been done
    };
    struct SurfaceSums;

    void keep_surfaces(std::size_t i, const RenderedPixel& pixel);
    void add_surface(const RenderedPixel& pixel, std::size_t sample, SurfaceSums& sums) const;
    void scatter_surfaces();
    void scatter_water(const std::function<void(std::size_t slab)>& done);
    // The factors on the light of pixel `i` before and after its blur on the way to the camera.
    double factor_before(std::size_t i) const {
        return setup_.sensor.factors_before_blur() ? pixel_factor_[i] : 1.0;
    }
    double factor_after(std::size_t i) const {
        return setup_.sensor.factors_before_blur() ? 1.0 : pixel_factor_[i];
    }
    std::vector<ImagePlane> planes(std::size_t count) const {
        return std::vector<ImagePlane>(count, ImagePlane(setup_.plane.width, setup_.plane.height));
    }

    const PixelRenderer& renderer_;
    LitScene scene_;
    const ForwardScatterSetup& setup_;
    LampPaths lamp_paths_;
    InScatterSlabs in_scatter_;
    std::size_t bands_;
    std::vector<Group> groups_;
    std::vector<std::size_t> group_of_lamp_;
    bool several_;                         // whether there is more than one group
    std::vector<ImagePlane> direct_;       // per band, if there are several groups
    std::vector<ImagePlane> backscatter_;  // per band, without what is added
    std::vector<ImagePlane> snow_;         // per band, if there is snow; not blurred
    std::vector<ImagePlane> added_;        // per group and band, to the backscatter
    std::vector<ImagePlane> first_;        // of it, in backscatter_first; empty if not requested
    std::vector<ImagePlane> response_;     // per band: direct light per irradiance [1/sr]
    Grid2D<float> pixel_factor_;
    PathImage from_lamps_, to_camera_;  // of the surfaces
    VisibleWater water_;
};

}  // namespace uw
