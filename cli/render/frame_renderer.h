#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "cli/progress.h"
#include "cli/render/frame_sequence.h"
#include "cli/render/render_arguments.h"
#include "cli/render/sequence_clock.h"
#include "cli/render/stats.h"
#include "render/renderer.h"

namespace uw {

/// Renders and writes the images of a run one after the other, and reports progress to the user.
class FrameRenderer {
  public:
    /// `scene`: of all frames; `windows`: the pixels written, by camera; `count`: the number of
    /// images to come. All references outlive the renderer.
    FrameRenderer(const RenderArguments& arguments, const SceneDesc& scene,
                  const std::vector<PixelWindow>& windows, std::size_t count);

    /// Renders one frame, with `scene` its own, and writes all its files but the statistics, which
    /// go to `stats`. Reports on stderr what it does; a warning that recurs in several frames with
    /// only the file's name changed is given once. Throws InputError, also if the image does not
    /// fit into memory; IoError; Interrupted, and then no image of this frame has been written.
    void render(const Frame& frame, ResolvedScene scene, RunStats& stats);

  private:
    bool proceed(const std::string& stage, double fraction);
    void begin_stage(const std::string& stage);
    void prepare(const Frame& frame, const RenderOptions& options);
    void count_work(RunStats& stats) const;
    void write_irradiance(const std::filesystem::path& file);
    void say(const std::string& line) const;
    void warn(const Frame& frame, const std::string& line);

    const RenderArguments& arguments_;
    const SceneDesc& all_frames_;
    const std::vector<PixelWindow>& windows_;
    SequenceClock clock_;
    Renderer renderer_;
    std::set<std::string> warned_;
    // The current stage: updated from any thread.
    std::mutex mutex_;
    std::string stage_;
    std::unique_ptr<Progress> progress_;
    RunStats* stats_ = nullptr;
};

}  // namespace uw
