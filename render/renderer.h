#pragma once

#include <cstdint>
#include <functional>
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

/// What is requested of one image beyond what its scene says.
struct RenderOptions {
    std::string layers{};                       // as LayerPlan takes them; empty: the default set
    std::optional<PixelWindow> window{};        // the pixels wanted; none: the whole image
    PathRequest paths{};                        // of its light paths
    std::int64_t frame = 0;                     // number, on which the sensor's noise depends
    const LightTransport* transport = nullptr;  // instead of the scene's; not owned
};

/// What an image was made of, and the warnings about it.
struct RenderReport : ImageProgress {
    /// About the scene, then about the image: one line each, in the order met.
    std::vector<std::string> warnings;
    /// What its light lacks (left_out_note), one line, set by those who ask; empty: little.
    std::string light_note;
    std::uint64_t pixels = 0;  // rendered: with forward scatter always the whole image
    std::uint64_t camera_rays = 0;
    std::uint64_t splat_rays = 0;     // traced for light not kept from the last image
    std::uint64_t light_bytes = 0;    // of all lamps' light
    std::uint64_t active_voxels = 0;  // of all grids
    std::uint64_t grid_bytes = 0;
    std::uint64_t triangles = 0, lamps = 0, bands = 0;
    /// Where something moves during the exposure: its parts (Exposure), the samples per pixel of
    /// all of them, and how far it moves in the image, at most [pixels]. 0: nothing moves.
    std::uint64_t exposure_parts = 0, exposure_samples = 0;
    double motion_pixels = 0;
    /// Groups of bands with rays of their own (ColourGroup), each an image that was rendered.
    std::uint64_t colour_groups = 1;
};

/// Renders images of scenes: the only path from a scene description to pixels.
///
///     Renderer renderer;
///     renderer.set_scene(load_scene("scene.yaml", {}));
///     write_exr("image.exr", renderer.render(), {});
///
/// Water, volumes, surfaces and light are kept from one image to the next as far as they and their
/// files are unchanged (SceneCache); every image is the same to the bit as from a new renderer. It
/// neither prints nor ends the program. Faults in files are an InputError or IoError, in options a
/// UsageError.
///
/// Stages, in this order: "volumes", "geometry", "splat", and those of the image's passes
/// (make_passes): "multiple scattering" if the integrator volume renders it, "snow" if there is
/// some, "render" and, with forward scatter, "forward scatter". `progress` receives each with 0
/// before it begins, on the calling thread. After Interrupted, or what `progress` throws, the
/// renderer stays usable, and the same image can be requested again.
class Renderer {
  public:
    explicit Renderer(StageProgressCallback progress = [](const std::string&, double) {})
        : progress_(std::move(progress)) {}

    /// Sets the scene of the images to come. Loads nothing yet.
    void set_scene(ImageScene scene);
    /// As it was set, or edited since. Precondition of this and all that follows: it was set.
    const ImageScene& scene() const { return *image_; }

    /// Allocates an image and assembles its scene: then the report has its warnings and its pixels.
    /// render() does so itself; call this to learn of them beforehand.
    void prepare(const RenderOptions& options = {});

    /// Renders the image. The film belongs to the renderer and stays as it is until the next image
    /// is prepared, which reuses its memory. Throws as require_memory;
    /// UsageError for a window that is not within the image, and as layer_plan.
    const Film& render(const RenderOptions& options = {});

    /// The film that render() returned last, for those who keep it: the next image gets memory of
    /// its own. Precondition: nothing has been prepared since.
    Film release_film();

    /// About the image that was prepared or rendered last.
    const RenderReport& report() const { return report_; }

    /// @name What images are made of, for closer inspection
    /// References to them are valid until the scene is set or edited again.
    /// @{

    /// Loads and builds the scene and places its slabs, as far as that has not been done.
    const AssembledScene& assemble();
    /// Likewise the light of its lamps, at the resolution that its quality requires. For an
    /// integrator that needs no light, forward scatter takes the columns from it if it is there.
    const DeepShadows& splat();
    /// The light transport of the scene's integrator, with its light if it needs any.
    LightTransport make_transport();

    /// What assemble() and splat() returned last. Precondition: they have been called.
    const AssembledScene& assembled() const { return *scene_; }
    const DeepShadows& light() const { return light_; }

    /// What an image of this scene leaves out (estimate_light_left_out); assembles it.
    std::optional<LightLeftOut> light_left_out();

    /// Changes the assembled scene by hand: for water, volumes and slabs that no description can
    /// express. The next scene that is set has nothing of it.
    void edit(const std::function<void(AssembledScene&)>& change);
    /// Frees the light: the next splat makes all of it anew.
    void drop_light();
    /// @}

  private:
    void begin(const std::string& stage) const;
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
    std::optional<ImageScene> image_;      // as it was set
    std::optional<AssembledScene> scene_;  // none: it has not been assembled
    SceneCache cache_;
    DeepShadows light_;             // of the scene; empty: not splatted
    std::uint64_t splat_rays_ = 0;  // since the last image
    std::optional<LayerPlan> plan_;
    std::optional<BandColour> colour_;  // of the scene; none: not looked up
    PassList passes_;                   // of the image that was prepared, until it is rendered
    PassNeeds needs_;                   // of these
    PixelWindow window_;                // wanted of the image
    std::optional<Film> film_;          // of what is rendered
    bool is_film_clear_ = false;
    std::optional<Film> cropped_;  // what is wanted of it, if that is less
    RenderReport report_;
};

}  // namespace uw
