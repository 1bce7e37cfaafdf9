#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "core/base/spectrum.h"
#include "core/image/colour.h"
#include "core/image/deep_image.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/light/integrator.h"
#include "core/passes/pixel_renderer.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// The accuracy that a path-traced image has reached.
struct PathAccuracy {
    int samples = 0;  // paths per pixel
    /// The standard error of the image: the RMS over pixels and bands of the error of the total,
    /// divided by the mean of the total. None for a single path.
    std::optional<double> error{};
};

/// The results of the passes of an image that are not pixels.
struct ImageProgress {
    /// The accuracy of a path-traced image so far. It changes only between calls of the progress
    /// callback.
    PathAccuracy paths;
    /// The estimated standard error of the light of MultipleScatteringPass, if that pass is run: of
    /// the image, relative to its mean, and of each band, relative to the band's mean.
    std::optional<double> multiple_error;
    std::vector<double> multiple_error_of_bands;
    /// That of the parts of the image, squares of a tenth of its height, relative to the light of
    /// each: the RMS over the parts, and the worst of them.
    double multiple_error_of_parts = 0, multiple_error_of_worst_part = 0;
    std::uint64_t snow_particles = 0;  // drawn

    /// Includes another image of the same scene, in other bands: keeps the maximum of each value.
    void include(const ImageProgress& other) {
        paths.samples = std::max(paths.samples, other.paths.samples);
        paths.error = std::max(paths.error, other.paths.error);
        include_multiple_error(other);
        snow_particles = std::max(snow_particles, other.snow_particles);
    }
    /// Includes the errors of another image: keeps the maximum of each.
    void include_multiple_error(const ImageProgress& other) {
        multiple_error = std::max(multiple_error, other.multiple_error);
        multiple_error_of_parts = std::max(multiple_error_of_parts, other.multiple_error_of_parts);
        multiple_error_of_worst_part =
            std::max(multiple_error_of_worst_part, other.multiple_error_of_worst_part);
        multiple_error_of_bands.resize(
            std::max(multiple_error_of_bands.size(), other.multiple_error_of_bands.size()));
        for (std::size_t b = 0; b < other.multiple_error_of_bands.size(); ++b)
            multiple_error_of_bands[b] =
                std::max(multiple_error_of_bands[b], other.multiple_error_of_bands[b]);
    }
};

/// A rendered pixel and its samples.
struct RenderedPixel {
    int x, y;
    const PixelView& view;
    const SurfaceLight& light;  // on its samples, from `first_sample` on
    std::size_t first_sample;
    PixelResult& result;
};

/// What a pass does with each pixel when PixelPass renders it: changes or stores it. Thread safe.
using PixelStep = std::function<void(const RenderedPixel& pixel)>;

struct SnowModel;

/// Where passes write their image, and what they report to. All references must outlive it.
struct ImageTarget {
    const LayerPlan& plan;
    const BandColour& colour;
    Film& film;  // its window is what is rendered
    const StageProgressCallback& progress;
    ImageProgress& reached;
    DeepImage* deep = nullptr;  // where DeepPass writes; null: no deep image is wanted

    /// Returns a callback that reports the progress of this stage to `progress`.
    ProgressCallback progress_of(Stage stage) const {
        return [this, stage](double fraction) { progress(stage, fraction); };
    }
};

/// The image, or the part of an exposure, that is being rendered: what its passes work on. Made by
/// make_rendering (render/scene_rendering.h).
struct Rendering : ImageTarget {
    const SceneDesc& desc;  // the scene of the image
    double time = 0;        // the time of that scene [s]; 0 if nothing moves
    PixelRenderer pixels;   // with the scene's rays, water, surfaces and light
    /// The deep shadow map of every emitter; empty if not needed.
    std::span<const std::shared_ptr<const DeepShadow>> light;
    const SnowModel* snow;  // null without snow
    /// Selects the rows for which TruthPass finds ground truth; empty: all rows.
    std::function<bool(int row)> has_truth{};
    /// Whether it takes what its passes share (Pass::share).
    bool is_shared = false;
    /// In the order in which they are applied to a pixel, before it is stored.
    std::vector<PixelStep> steps{};
    /// The light of MultipleScatteringPass that the water up to a distance along a pixel's ray [m]
    /// scatters to the camera, by band; empty if that pass is not run.
    std::function<Spectrum(const PixelView& view, double distance)> multiple_up_to{};
};

/// What a pass needs before it is run.
struct PassNeeds {
    bool light = false;        // the deep shadow maps of the lamps
    bool slabs = false;        // the scene's slabs, placed
    bool paths = false;        // LightTransport::paths
    bool whole_image = false;  // whatever the window, as light comes from outside it
};

/// A step in rendering an image, which runs a list of them (PassList). A pass knows the scene from
/// which the list was made. It may keep what it computes for an image until the next image begins.
class Pass {
  public:
    /// What a pass is run on if something moves while the shutter is open.
    enum class Of {
        light,  ///< every part of the exposure, whose images are averaged
        truth,  ///< the exposure's middle; not run if nothing moves, since the pixels contain it
                ///< already
        image,  ///< the whole image, after everything else
    };

    /// `stage`: whose progress it reports; none for a pass that takes no time.
    explicit Pass(std::optional<Stage> stage, Of of = Of::light) : stage_(stage), of_(of) {}
    virtual ~Pass() = default;
    Pass(const Pass&) = delete;
    Pass(Pass&&) = delete;
    Pass& operator=(const Pass&) = delete;
    Pass& operator=(Pass&&) = delete;

    std::optional<Stage> stage() const { return stage_; }
    Of of() const { return of_; }

    /// What the pass needs for an image with these layers.
    virtual PassNeeds needs(const LayerPlan& plan) const;
    /// Adds the layers that the pass provides, apart from those that every image has.
    virtual void provide(LayerSupply& supply) const;
    /// Reads the files that the pass needs for these layers, before anything else is loaded.
    virtual void prepare(const SceneDesc& scene, const LayerPlan& plan);
    /// Computes what the images that follow share if they are `is_shared`: the parts of an exposure
    /// around the moment of `middle`, until this is called again. Throws as run.
    virtual void share(Rendering& middle);
    /// Adds the pass's step to the rendering, if it has one. All passes begin before the first one
    /// is run.
    virtual void begin(Rendering& rendering);
    /// Runs the pass. Throws Interrupted, and as require_memory.
    virtual void run(Rendering& rendering) = 0;
    /// Completes what the pass's step has collected, after the last pass was run.
    virtual void end(Rendering& rendering);

  private:
    std::optional<Stage> stage_;
    Of of_;
};

/// The passes of an image, in the order in which they are run.
class PassList {
  public:
    template <class AnyPass, class... Arguments>
    void add(Arguments&&... arguments) {
        passes_.push_back(std::make_unique<AnyPass>(std::forward<Arguments>(arguments)...));
    }

    /// The layers that all passes provide.
    LayerSupply supply() const;
    /// What any of the passes needs.
    PassNeeds needs(const LayerPlan& plan) const;
    /// Prepares all passes.
    void prepare(const SceneDesc& scene, const LayerPlan& plan);
    /// Calls Pass::share of all passes of the light.
    void share(Rendering& middle);
    /// Begins, runs and ends the passes of this kind. Progress 0 is reported for each stage before
    /// it begins.
    void run(Pass::Of of, Rendering& rendering);

  private:
    std::vector<std::unique_ptr<Pass>> passes_;
};

}  // namespace uw
