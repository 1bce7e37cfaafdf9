#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/render/frame_sequence.h"
#include "cli/render/image_output.h"
#include "cli/render/render_arguments.h"
#include "cli/render/run_stats.h"
#include "core/image/pixel_image.h"
#include "render/renderer.h"

namespace uw {

/// Renders and writes the images of a run one after the other, and reports progress to the user.
/// Each is written while the next is rendered.
class FrameRenderer {
  public:
    /// Receives each frame that has been written, with its statistics, from any thread.
    using Done = std::function<void(const Frame& frame, RunStats stats)>;

    /// `count`: the number of images to come; `noun`: what messages call one of them. `arguments`
    /// outlive the renderer.
    FrameRenderer(const RenderArguments& arguments, std::size_t count, std::string noun, Done done);
    ~FrameRenderer();
    FrameRenderer(const FrameRenderer&) = delete;
    FrameRenderer& operator=(const FrameRenderer&) = delete;
    FrameRenderer(FrameRenderer&&) = delete;
    FrameRenderer& operator=(FrameRenderer&&) = delete;

    /// Renders one frame, with `scene` its own, and has all its files but the statistics written.
    /// `stats` are continued. Reports on stderr what it does; a warning that recurs in several
    /// frames with only the file's name changed is given once. Throws InputError, also if the image
    /// does not fit into memory; IoError, of this frame or the one before; Interrupted, and then no
    /// file of this frame is written.
    void render(const Frame& frame, ImageScene scene, RunStats stats);

    /// The exposure of all previews from now on, where that is the first image's and that has been
    /// rendered before.
    void keep_exposure(double exposure) { first_exposure_ = exposure; }

    /// Waits until the last frame rendered has been written. Throws IoError if it cannot be, and
    /// Interrupted if it has been given up.
    void finish();

  private:
    /// An image that is being written.
    struct Written;

    bool proceed(const std::string& stage, double fraction);
    void begin_stage(const std::string& stage);
    void prepare(const Frame& frame, const RenderOptions& options);
    void count_work(RunStats& stats) const;
    void write_irradiance(OutputFile& out);
    /// `outputs`: what has been written with the image so far.
    void begin_writing(const Frame& frame, Film film, std::optional<SensorImage> sensor,
                       ImageMetadata metadata, RunStats stats, OutputGroup outputs);
    /// Measures the image, lamp by lamp; the renderer's scene is then another.
    std::vector<PartNumbers> measure(const ImageScene& scene, const Film& film,
                                     const RenderOptions& options);
    void say(const std::string& line) const;
    /// `is_first`: of the run's frames, whose warnings need not say which.
    void warn(const Frame& frame, bool is_first, const std::string& line);
    bool is_first() const { return clock_.images_done() == 0; }

    const RenderArguments& arguments_;
    SequenceClock clock_;
    Renderer renderer_;
    std::set<std::string> warned_;
    // The current stage: updated from any thread.
    std::mutex mutex_;
    std::string stage_;
    std::unique_ptr<Progress> progress_;
    /// Of the preview of the image rendered last; none: its own.
    std::optional<double> exposure_of(const Film& film);

    std::optional<double> first_exposure_;  // where it is kept; none: not known yet
    std::string measuring_;                 // what is rendered for its numbers only; empty: nothing
    RunStats* stats_ = nullptr;
    Done done_;
    std::unique_ptr<Written> written_;
    std::unique_ptr<BackgroundTask> writing_;  // uses the one before
};

}  // namespace uw
