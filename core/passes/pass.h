#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "core/image/colour.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/light/integrator.h"
#include "core/passes/pixel_renderer.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// What an image of light paths has reached.
struct PathAccuracy {
    int samples = 0;  // paths per pixel
    /// The standard error of the image: the RMS over pixels and bands of that of the total, over
    /// the total's mean. None for a single path.
    std::optional<double> error{};
};

/// What the passes of an image have reached.
struct ImageProgress {
    /// What an image of light paths has reached so far; it changes only between two calls of the
    /// progress callback.
    PathAccuracy paths;
    /// The stated standard error of light scattered more than once, where MultipleScatteringPass
    /// renders it, relative to the image's mean, and that of each band, relative to the band's
    /// mean.
    std::optional<double> multiple_error;
    std::vector<double> multiple_error_of_bands;
    std::uint64_t snow_particles = 0;  // drawn

    /// Takes in another image of the same scene, in other bands: the greatest of each.
    void include(const ImageProgress& other) {
        paths.samples = std::max(paths.samples, other.paths.samples);
        paths.error = std::max(paths.error, other.paths.error);
        include_multiple_error(other);
        snow_particles = std::max(snow_particles, other.snow_particles);
    }
    /// Takes in the greater of each stated error.
    void include_multiple_error(const ImageProgress& other) {
        multiple_error = std::max(multiple_error, other.multiple_error);
        multiple_error_of_bands.resize(
            std::max(multiple_error_of_bands.size(), other.multiple_error_of_bands.size()));
        for (std::size_t b = 0; b < other.multiple_error_of_bands.size(); ++b)
            multiple_error_of_bands[b] =
                std::max(multiple_error_of_bands[b], other.multiple_error_of_bands[b]);
    }
};

/// A pixel and what it was made of.
struct RenderedPixel {
    int x, y;
    const PixelView& view;
    const SurfaceLight& light;  // on its samples, from `first_sample` on
    std::size_t first_sample;
    PixelResult& result;
};

/// What a pass does to each pixel, or keeps of it, while PixelPass renders it. Thread safe.
using PixelStep = std::function<void(const RenderedPixel& pixel)>;

struct SnowModel;

/// One image in the making, or that of a part of an exposure: what its passes work on.
struct Rendering {
    const SceneDesc& desc;        // what it shows
    double time = 0;              // the moment of that [s]; 0 where nothing moves
    const PixelRenderer& pixels;  // of the scene's rays, its water and surfaces, and their light
    /// The light of every emitter, splatted; empty if it was not needed.
    std::span<const std::shared_ptr<const DeepShadow>> light;
    const SnowModel* snow;  // null: there is none
    const LayerPlan& plan;
    const BandColour& colour;
    Film& film;  // its window is what is rendered
    const StageProgressCallback& progress;
    ImageProgress& reached;
    /// The rows whose ground truth TruthPass finds; empty: all of them.
    std::function<bool(int row)> has_truth{};
    /// In the order in which they are done to a pixel, before it is stored.
    std::vector<PixelStep> steps{};

    /// What tells `progress` how far this stage is.
    ProgressCallback progress_of(const std::string& stage) const {
        return [this, stage](double fraction) { progress(stage, fraction); };
    }
};

/// What has to be there before a pass is run.
struct PassNeeds {
    bool light = false;        // the lamps' light, splatted
    bool slabs = false;        // the scene's slabs, placed
    bool paths = false;        // LightTransport::paths
    bool whole_image = false;  // whatever the window wanted: light comes from outside it
};

/// A step on the way from a scene to the finished image, which is a list of them (PassList). It
/// knows of the scene what the list was made from; what it makes for an image it may hold until
/// the next one begins.
class Pass {
  public:
    /// What a pass is run on where something moves while the shutter is open.
    enum class Of {
        light,  ///< every part of the exposure, whose light is averaged
        truth,  ///< the exposure's middle; not at all where nothing moves: pixels hold it already
        image,  ///< the whole image, after everything else
    };

    /// `stage`: under which its progress is told; empty: it takes no time.
    explicit Pass(std::string stage, Of of = Of::light) : stage_(std::move(stage)), of_(of) {}
    virtual ~Pass() = default;
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

    const std::string& stage() const { return stage_; }
    Of of() const { return of_; }

    /// What has to be there for an image with these layers.
    virtual PassNeeds needs(const LayerPlan& plan) const;
    /// Adds the layers that it provides, apart from those that every image has.
    virtual void provide(LayerSupply& supply) const;
    /// Reads the files that it needs for these layers, before anything else is loaded.
    virtual void prepare(const SceneDesc& scene, const LayerPlan& plan);
    /// Adds its step to the rendering, if it takes part in each pixel. All passes begin before the
    /// first is run.
    virtual void begin(Rendering& rendering);
    /// Does its work. Throws Interrupted, and as require_memory.
    virtual void run(Rendering& rendering) = 0;
    /// Sums up what its step has seen of the pixels, after the last pass was run.
    virtual void end(Rendering& rendering);

  private:
    std::string stage_;
    Of of_;
};

/// The passes of an image, in the order in which they are run.
class PassList {
  public:
    template <class AnyPass, class... Arguments>
    void add(Arguments&&... arguments) {
        passes_.push_back(std::make_unique<AnyPass>(std::forward<Arguments>(arguments)...));
    }

    /// What all of them provide.
    LayerSupply supply() const;
    /// What any of them needs.
    PassNeeds needs(const LayerPlan& plan) const;
    /// Prepares all of them.
    void prepare(const SceneDesc& scene, const LayerPlan& plan);
    /// Begins and runs those of this kind. Each stage is told with 0 before it begins.
    void run(Pass::Of of, Rendering& rendering);

  private:
    std::vector<std::unique_ptr<Pass>> passes_;
};

}  // namespace uw
