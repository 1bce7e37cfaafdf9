#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "cli/frame_sequence.h"
#include "cli/render/sequence_clock.h"
#include "cli/render/stats.h"
#include "cli/render_arguments.h"
#include "core/colour/colour.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "render/light_splatter.h"
#include "render/scene_assembly.h"
#include "render/scene_rendering.h"

namespace uw {

/// What the images of one run have in common, beside the scene.
struct ImagePlan {
    std::vector<PixelWindow> windows;  // of the pixels written, by camera
    LayerPlan layers;
    BandColour colour;
};

/// Renders and writes the images of a run one after the other. Each takes from the one before what
/// is the same: water, surfaces, shadows, volumes, columns.
class FrameRenderer {
  public:
    /// `desc`: the scene of all frames; `count`: how many there will be. `arguments` outlives the
    /// renderer.
    FrameRenderer(const RenderArguments& arguments, const SceneDesc& desc, ImagePlan plan,
                  std::size_t count);

    /// Renders one frame, `desc` its scene, and writes all its files but the statistics, whose
    /// figures go to `stats`. Says on stderr what it does; a warning that is the same for several
    /// frames but for the file's name is given once. Throws InputError, also if the image does not
    /// fit into memory; IoError; Interrupted, and then no image of this frame has been written.
    void render(const Frame& frame, const SceneDesc& desc, RunStats& stats);

  private:
    const PixelWindow& window(const Frame& frame) const { return plan_.windows[frame.camera]; }
    void fit_film(const Frame& frame, const CameraDesc& camera);
    void assemble(const Frame& frame, const SceneDesc& desc, RunStats& stats);
    DeepShadows splat(bool with_irradiance);
    void render_image(const DeepShadows& deep_shadows);
    void write_irradiance(const std::filesystem::path& file, const DeepShadows& deep_shadows);
    void write_image(const Frame& frame);
    void say(const std::string& line) const;
    void warn(const Frame& frame, const std::string& line);

    const RenderArguments& arguments_;
    SceneDesc all_frames_;
    ImagePlan plan_;
    Film film_;
    SequenceClock clock_;
    AssembledScene scene_;
    LightSplatter splatter_;
    std::set<std::string> warned_;
};

}  // namespace uw
