#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/correspondences.h"
#include "render/exposure.h"
#include "render/image_scene.h"
#include "render/light_left_out.h"
#include "render/scene_assembly.h"
#include "render/scene_cache.h"
#include "render/scene_rendering.h"

namespace uw {

/// Options of one image that its scene does not determine.
struct RenderOptions {
    std::string layers{};                 // the request of a LayerPlan; empty: the default set
    std::optional<PixelWindow> window{};  // the requested pixels; none: the whole image
    PathRequest paths{};                  // of its light paths
    std::int64_t frame = 0;               // its number, on which the sensor's noise depends
    int deep = 0;  // the maximum of samples per pixel of its deep image; 0: none is made
    const LightTransport* transport = nullptr;  // instead of the scene's; not owned
};

/// Statistics of an image, and the warnings about it.
struct RenderReport : ImageProgress {
    /// Warnings about the scene, then about the image: one line each, in the order of their
    /// occurrence.
    std::vector<std::string> warnings;
    /// Note on the light that the image leaves out (left_out_note), one line, set by callers that
    /// ask for it; empty: little.
    std::string light_note;
    std::uint64_t pixels = 0;  // pixels rendered: with forward scatter, always the whole image
    std::uint64_t camera_rays = 0;
    std::uint64_t splat_rays = 0;     // for deep shadow maps that were not kept from the last image
    std::uint64_t light_bytes = 0;    // of all deep shadow maps
    std::uint64_t active_voxels = 0;  // of all grids
    std::uint64_t grid_bytes = 0;
    std::uint64_t triangles = 0, lamps = 0, bands = 0;
    /// If something moves during the exposure: the number of its parts (Exposure), the samples per
    /// pixel of all of them, and the maximum motion in the image [pixels]; 0 if nothing moves.
    std::uint64_t exposure_parts = 0, exposure_samples = 0;
    double motion_pixels = 0;
    /// The number of groups of bands with rays of their own (ColourGroup), each of which is
    /// rendered as an image.
    std::uint64_t colour_groups = 1;
};

/// Renders images of scenes. No other class turns scene descriptions into pixels.
///
///     Renderer renderer;
///     renderer.set_scene(load_scene("scene.yaml", {}));
///     write_exr("image.exr", renderer.render(), {});
///
/// Water, volumes, surfaces and deep shadow maps are kept from one image to the next if they and
/// their files have not changed (SceneCache); every image is the same to the bit as from a new
/// renderer. The renderer neither prints nor ends the program. Faults in files are an InputError or
/// IoError, faults in options a UsageError.
///
/// The stages are, in this order, "volumes", "geometry", "splat", and those of the image's passes
/// (make_passes): "multiple scattering" if the integrator volume renders it, "snow" if there is
/// some, "render" and, with forward scatter, "forward scatter". `progress` receives each stage with
/// 0 before it begins, on the calling thread. After Interrupted, or an exception of `progress`, the
/// renderer stays usable, and the same image can be requested again.
class Renderer {
  public:
    explicit Renderer(StageProgressCallback progress = [](Stage, double) {})
        : progress_(std::move(progress)) {}

    /// Sets the scene of the following images. Loads nothing yet.
    void set_scene(ImageScene scene);
    /// Sets a scene that is assembled already.
    void set_scene(AssembledScene scene);
    /// The scene that was set. Precondition of this and all following functions: a scene was set.
    const ImageScene& scene() const { return *image_; }

    /// Allocates an image and assembles its scene, after which the report has its warnings and its
    /// number of pixels. render() does so itself; call this to know them beforehand.
    void prepare(const RenderOptions& options = {});

    /// Renders the image. The film belongs to the renderer and is valid until the next image is
    /// prepared, which reuses its memory. Throws as require_memory; UsageError for a window that is
    /// not within the image, and as layer_plan.
    const Film& render(const RenderOptions& options = {});

    /// Releases the film that render() returned last; the next image gets memory of its own.
    /// Precondition: nothing has been prepared since.
    Film release_film();

    /// Releases the deep image that was rendered with it; none unless it was wanted.
    std::optional<DeepImage> release_deep() { return std::exchange(deep_, std::nullopt); }

    /// The report on the image that was prepared or rendered last.
    const RenderReport& report() const { return report_; }

    /// @name The parts of an image's scene, for closer inspection
    /// References to them are valid until a scene is set again.
    /// @{

    /// Loads and builds the scene and places its slabs, unless that has been done.
    const AssembledScene& assemble();
    /// Makes the deep shadow maps of its lamps, at the resolution that its quality requires, unless
    /// that has been done. For an integrator that does not need them, forward scatter takes columns
    /// from them if they exist.
    const DeepShadows& splat();
    /// Makes the light transport of the scene's integrator, with deep shadow maps if it needs them.
    LightTransport make_transport();

    /// The results of the last assemble() and splat(). Precondition: they have been called.
    const AssembledScene& assembled() const { return *scene_; }
    const DeepShadows& light() const { return light_; }

    /// Estimates the light that an image of this scene leaves out (estimate_light_left_out);
    /// assembles the scene.
    std::optional<LightLeftOut> light_left_out();

    /// Frees the deep shadow maps: the next splat makes all of them anew.
    void drop_light();
    /// @}

  private:
    void begin(Stage stage) const;
    void build();
    void fit_film(const RenderOptions& options);
    void count_work();
    void warn_of_error(const PathRequest& request);
    void warn_of_multiple_error();
    void render_film(const RenderOptions& options, PassList& passes);
    void render_light(const Exposure& exposure, const AssembledScene& scene, PassList& passes,
                      Rendering& rendering);
    void render_other_groups(std::span<const ColourGroup> groups, const RenderOptions& options,
                             PassList& passes);
    StageProgressCallback progress_of_group(std::size_t group, std::size_t groups) const;
    DeepShadows light_of(const AssembledScene& scene, const ProgressCallback& progress);

    StageProgressCallback progress_;
    std::optional<ImageScene> image_;      // the scene that was set, or what it was assembled from
    std::optional<AssembledScene> scene_;  // none: not assembled yet
    SceneCache cache_;
    DeepShadows light_;             // of the scene; empty: not made yet
    std::uint64_t splat_rays_ = 0;  // traced since the last image
    std::optional<LayerPlan> plan_;
    std::optional<BandColour> colour_;  // of the scene; none: not made yet
    PassList passes_;                   // of the prepared image, until it is rendered
    PassNeeds needs_;                   // of these
    PixelWindow window_;                // the requested one
    std::optional<Film> film_;          // of the rendered window
    bool is_film_clear_ = false;
    std::optional<Film> cropped_;    // the requested part of it, if that is smaller
    std::optional<DeepImage> deep_;  // of the requested window; none: not wanted
    RenderReport report_;
};

}  // namespace uw
