#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "core/geometry/surfaces.h"
#include "core/image/exr_file.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/image/pixel_image.h"
#include "render/renderer.h"
#include "render/run/background_task.h"
#include "render/run/job.h"

namespace uw {

/// The progress of a run of several images, and the time that it will still take.
class SequenceClock {
  public:
    /// `noun`: what messages call one of them.
    explicit SequenceClock(std::size_t images, std::string noun = "frame")
        : images_(images), noun_(std::move(noun)) {}

    void finish_image() { ++done_; }
    std::size_t images_done() const { return done_; }
    bool finished() const { return done_ == images_; }
    bool is_sequence() const { return images_ > 1; }

    /// The progress over all images, 0..1, with `fraction` done of the one that is rendered.
    double progress(double fraction) const {
        return (static_cast<double>(done_) + fraction) / static_cast<double>(images_);
    }

    /// "frame 3 of 10: render"; of a single image "render".
    std::string label(const std::string& pass) const {
        if (!is_sequence()) return pass;
        return noun_ + " " + std::to_string(done_ + 1) + " of " + std::to_string(images_) + ": " +
               pass;
    }

    /// From now until all images are done, if they take as long as those before [s]; empty until
    /// the first is done.
    std::optional<double> seconds_left() const {
        if (!is_sequence() || done_ == 0) return std::nullopt;
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
        return elapsed.count() * static_cast<double>(images_ - done_) / static_cast<double>(done_);
    }

  private:
    std::size_t images_;
    std::string noun_;
    std::size_t done_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The requirements on one image.
struct WantedImage {
    RenderOptions options{};    ///< but for the frame's number, which follows from the job
    bool camera_image = false;  ///< with what the camera's sensor makes of it; it must have one
};

/// An image that was rendered, with all that is known about it.
struct FinishedImage {
    Film film;
    LayerPlan plan;                      ///< of the film
    std::optional<DigitalImage> sensor;  ///< the camera's image, if it was wanted
    ImageMetadata metadata;
    RenderReport report;
    std::shared_ptr<const Surfaces> surfaces;
    std::optional<DeepImage> deep{};  ///< if it was wanted: in the film's window or more
};

/// The remaining work on an image once it is rendered; empty: none.
struct ImageWork {
    /// In the background, while the next image is rendered.
    std::function<void()> write{};
    /// Once that is done: from any thread, but never beside RunClient::tell.
    std::function<void()> written{};
};

/// The command whose images a job renders. The hooks are called on the thread that runs the job, in
/// the order below for each image, by its place in the job; what they throw ends the run.
class RunClient {
  public:
    RunClient() = default;
    virtual ~RunClient() = default;
    RunClient(const RunClient&) = delete;
    RunClient& operator=(const RunClient&) = delete;
    RunClient(RunClient&&) = delete;
    RunClient& operator=(RunClient&&) = delete;

    /// Returns the requirements on an image, and may change its scene: to a draft, for instance.
    virtual WantedImage want(std::size_t place, ImageScene& scene) = 0;
    /// The image's scene has been loaded; nothing is rendered yet.
    virtual void loaded(std::size_t /*place*/) {}
    /// The image has been rendered. The renderer still has the data from which it was made.
    virtual ImageWork take(std::size_t place, FinishedImage image) = 0;

    /// A warning that has not been given in this run; see RunEngine::warn.
    virtual void warn(std::size_t place, const std::string& line) = 0;
    /// Whether anybody reads RenderReport::light_note, which takes a tenth of an image's time.
    virtual bool reads_light_note() const { return false; }
    /// How far a stage of the image is (StageProgressCallback); from any thread, one call at a
    /// time.
    virtual void tell(Stage stage, double fraction) = 0;
};

/// Goes through the images of a job: reads the scene of each, renders it, hands it to the command
/// whose job it is, and has it written while the next is rendered. All are rendered by one
/// Renderer, also those of several jobs.
class RunEngine {
  public:
    RunEngine();
    ~RunEngine() = default;
    RunEngine(const RunEngine&) = delete;
    RunEngine& operator=(const RunEngine&) = delete;
    RunEngine(RunEngine&&) = delete;
    RunEngine& operator=(RunEngine&&) = delete;

    /// Renders all images of a job; `noun` is what messages call one of them. However the run ends,
    /// what was rendered is written, but for the last image of a run that is stopped. Throws what
    /// reading, rendering, writing and the hooks throw: InputError; OutOfMemory, by a run of
    /// several images only if memory is lacking for a minute; IoError, of the image before as well;
    /// Interrupted.
    void run(const Job& job, RunClient& client, const std::string& noun = "image");

    /// Lends the renderer, between runs, to other work; `client` receives the progress of its
    /// stages. Throws what `work` throws.
    void lend(RunClient& client, const std::function<void(Renderer& renderer)>& work) {
        client_ = &client;
        work(renderer_);
    }

    /// For the hooks: the renderer of the image.
    Renderer& renderer() { return renderer_; }
    /// For the hooks: the progress of the run. An image counts once its writing has begun.
    const SequenceClock& clock() const { return *clock_; }
    /// How many images of the job have been written.
    std::size_t written() const { return written_; }

    /// Passes a warning about an image on, unless the run has given it before, of another file of
    /// the same sequence perhaps.
    void warn(std::size_t place, const std::string& line);
    /// Passes on what the renderer warns of so far: a hook that prints of its own calls it at the
    /// right moment.
    void warn_of_image();

  private:
    void tell(Stage stage, double fraction);
    void render_all(const Job& job);
    void render(std::size_t place);
    FinishedImage finished(const WantedImage& wanted);
    void begin_writing(ImageWork work, std::size_t bytes);
    void finish_writing();

    Renderer renderer_;
    const Job* job_ = nullptr;  // while it is run, like all that follows
    RunClient* client_ = nullptr;
    std::optional<SequenceClock> clock_;
    std::size_t place_ = 0;
    std::size_t warned_of_image_ = 0;  // so many of the renderer's warnings
    bool looked_for_light_ = false;    // of its first image: others leave out about as much
    std::set<std::string> warned_;
    std::size_t written_ = 0;
    std::mutex mutex_;  // of tell
    std::function<void()> when_written_;
    std::unique_ptr<BackgroundTask> writing_;
};

}  // namespace uw
