#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/render/frame_sequence.h"
#include "cli/render/render_arguments.h"
#include "cli/render/run_stats.h"
#include "core/image/preview_exposure.h"
#include "render/run/run_engine.h"

namespace uw {

std::vector<std::string> names_of(const std::vector<LampDesc>& lamps);

/// Renders the images of a run of `uwvdb render`, writes them, measures them if that is requested,
/// and reports to the user.
class FrameRenderer : public RunClient {
  public:
    /// Receives each frame that has been written, with its statistics, from any thread.
    using Done = std::function<void(const Frame& frame, RunStats stats)>;

    /// `lamps`: the names of the lamps that all frames have; `stats`: those of the first frame so
    /// far, which are continued. The arguments and the frames outlive the renderer.
    FrameRenderer(const RenderArguments& arguments, const std::vector<Frame>& frames,
                  std::vector<std::string> lamps, RunExposure exposure, RunStats stats, Done done);

    /// Renders all frames, and has all their files but the statistics written. Reports on stderr
    /// what it does. Throws InputError, also if an image does not fit into memory or has other
    /// lamps; IoError; Interrupted. The frames that were rendered are written then, but for the
    /// last one of a run that was stopped.
    void run(JobScenes& scenes);

    bool reads_light_note() const override { return !arguments_.quiet; }
    WantedImage want(std::size_t place, ImageScene& scene) override;
    void loaded(std::size_t place) override;
    ImageWork take(std::size_t place, FinishedImage image) override;
    void warn(std::size_t place, const std::string& line) override;
    void tell(Stage stage, double fraction) override;

  private:
    /// An image that is being written.
    struct Written;

    void begin_stage(Stage stage);
    void count_work(const RenderReport& report);
    void write_irradiance(OutputFile& out);
    /// Measures the image, lamp by lamp; the renderer's scene is then another.
    std::vector<PartNumbers> measure(const FinishedImage& image);
    void finish(Written& written);
    void say(const std::string& line) const;

    const RenderArguments& arguments_;
    const std::vector<Frame>& frames_;
    std::vector<std::string> lamps_;
    RunExposure exposure_;
    RunStats stats_;  // of the image that is rendered
    Done done_;
    RenderOptions options_;               // likewise, with what is measured
    std::optional<ImageScene> measured_;  // likewise, if it is measured
    std::optional<Stage> stage_;          // that was told of last
    std::unique_ptr<Progress> progress_;  // of the stage
    std::string measuring_;               // what is rendered for its numbers only; empty: nothing
    RunEngine engine_;
};

}  // namespace uw
