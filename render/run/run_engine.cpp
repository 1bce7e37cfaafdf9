#include "render/run/run_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/image/development.h"
#include "render/image_header.h"
#include "render/light_points.h"

namespace uw {

RunEngine::RunEngine()
    : renderer_([this](Stage stage, double fraction) { tell(stage, fraction); }) {}

void RunEngine::tell(Stage stage, double fraction) {
    const std::lock_guard lock(mutex_);
    if (writing_ && writing_->is_done()) finish_writing();
    client_->tell(stage, fraction);
}

void RunEngine::run(const Job& job, RunClient& client, const std::string& noun) {
    job_ = &job;
    client_ = &client;
    clock_.emplace(job.images.size(), noun);
    warned_.clear();
    written_ = 0;
    try {
        render_all(job);
        finish_writing();
    } catch (const Interrupted&) {
        try {
            finish_writing();
        } catch (const Interrupted&) {
            // It was being written, and is not done.
        }
        throw;
    } catch (...) {
        finish_writing();
        throw;
    }
}

namespace {

constexpr double k_patience = 60;  // s: for memory that other programs have

}  // namespace

// A long run waits for memory that is lacking for a moment.
void RunEngine::render_all(const Job& job) {
    MemoryWait wait = MemoryWaitScope::of_this_thread();
    if (job.images.size() > 1) {
        wait.seconds = k_patience;
        wait.tell = [this](const std::string& line) {
            client_->warn(place_,
                          fmt::format("{}; it is tried again for {:g} s", line, k_patience));
        };
    }
    const MemoryWaitScope scope(wait);
    for (std::size_t place = 0; place < job.images.size(); ++place) {
        renew_memory_limit();
        render(place);
    }
}

namespace {

// The window with as many more pixels of the image around it.
PixelWindow grown(const PixelWindow& window, int margin, const CameraDesc& camera) {
    return {std::max(window.x0 - margin, 0), std::max(window.y0 - margin, 0),
            std::min(window.x1 + margin, camera.width),
            std::min(window.y1 + margin, camera.height)};
}

PixelWindow window_of(const WantedImage& wanted, const CameraDesc& camera) {
    return wanted.options.window.value_or(PixelWindow{0, 0, camera.width, camera.height});
}

// The layers to render, including those that the camera's image needs.
RenderOptions rendered_for(const WantedImage& wanted, const CameraDesc& camera) {
    RenderOptions options = wanted.options;
    if (!wanted.camera_image) return options;
    options.layers = (options.layers.empty() ? "default" : options.layers) + ",sensor";
    options.window = grown(window_of(wanted, camera), Development(*camera.sensor).margin(), camera);
    return options;
}

// One line about the light that the image leaves out; empty if it is little.
std::string light_note_of(Renderer& renderer) {
    const auto left_out = renderer.light_left_out();
    const AssembledScene& scene = renderer.assembled();
    std::vector<std::string> notes = pointed_lamp_notes(scene, find_pointed_lamps(scene));
    if (auto note = left_out_note(scene, left_out)) notes.insert(notes.begin(), std::move(*note));
    return fmt::format("{}", fmt::join(notes, "; "));
}

}  // namespace

void RunEngine::render(std::size_t place) {
    const JobImage& image = job_->images[place];
    place_ = place;
    warned_of_image_ = 0;
    ImageScene scene = job_->scenes.take(image);
    WantedImage wanted = client_->want(place, scene);
    wanted.options.frame = image.choice.frame.value_or(0);
    const RenderOptions options = rendered_for(wanted, scene.desc().camera);
    renderer_.set_scene(std::move(scene));
    renderer_.prepare(options);
    std::string light_note;
    if (client_->reads_light_note() && !std::exchange(looked_for_light_, true))
        light_note = light_note_of(renderer_);
    client_->loaded(place);
    warn_of_image();
    renderer_.render(options);
    warn_of_image();
    FinishedImage there = finished(wanted);
    there.report.light_note = std::move(light_note);
    const std::size_t bytes = there.film.values().size_bytes();
    ImageWork work = client_->take(place, std::move(there));
    begin_writing(std::move(work), bytes);
}

FinishedImage RunEngine::finished(const WantedImage& wanted) {
    const ImageScene& scene = renderer_.scene();
    const RenderOptions& options = wanted.options;
    FinishedImage image{renderer_.release_film(),
                        layer_plan(scene, options.layers, options.paths),
                        std::nullopt,
                        metadata_of(renderer_.assembled(), job_->images[place_].choice.frame,
                                    options.paths, renderer_.report()),
                        renderer_.report(),
                        renderer_.assembled().surfaces,
                        renderer_.release_deep()};
    if (!wanted.camera_image) return image;
    const CameraDesc& camera = scene.desc().camera;
    const PixelWindow window = window_of(wanted, camera);
    image.sensor = Development(*camera.sensor)(image.film, window);
    if (image.film.window() != window || image.film.channel_names() != image.plan.channel_names())
        image.film = with_channels(image.film, image.plan.channel_names(), window);
    return image;
}

void RunEngine::begin_writing(ImageWork work, std::size_t bytes) {
    finish_writing();
    clock_->finish_image();
    if (!work.write) {
        ++written_;
        return;
    }
    when_written_ = std::move(work.written);
    writing_ = std::make_unique<BackgroundTask>(std::move(work.write));
    // The next image needs as much memory again, and some to work with.
    if (2 * bytes > available_memory_bytes()) finish_writing();
}

void RunEngine::finish_writing() {
    if (!writing_) return;
    const std::unique_ptr<BackgroundTask> writing = std::move(writing_);
    const std::function<void()> when_written = std::exchange(when_written_, nullptr);
    writing->finish();
    ++written_;
    if (when_written) when_written();
}

namespace {

// `warning` without the frame: with the names of the sequences instead of their files.
std::string without_frame(std::string warning, const SceneDesc& frame, const SceneDesc& all) {
    const auto replace = [&](const auto& of_frame, const auto& of_all) {
        const std::string file = of_frame.file.string();
        const std::size_t at = warning.find(file);
        if (of_all.is_sequence && at != std::string::npos)
            warning.replace(at, file.size(), of_all.file.string());
    };
    for (std::size_t v = 0; v < frame.volumes.size(); ++v)
        replace(frame.volumes[v], all.volumes[v]);
    for (std::size_t g = 0; g < frame.geometry.size(); ++g)
        replace(frame.geometry[g], all.geometry[g]);
    return warning;
}

}  // namespace

void RunEngine::warn(std::size_t place, const std::string& line) {
    const ImageScene& scene = renderer_.scene();
    if (warned_.insert(without_frame(line, scene.desc(), scene.whole())).second)
        client_->warn(place, line);
}

void RunEngine::warn_of_image() {
    const std::vector<std::string>& warnings = renderer_.report().warnings;
    while (warned_of_image_ < warnings.size()) warn(place_, warnings[warned_of_image_++]);
}

}  // namespace uw
