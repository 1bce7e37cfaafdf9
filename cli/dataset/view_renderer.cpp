#include "cli/dataset/view_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "camera/image_size.h"
#include "cli/console.h"
#include "cli/render/image_output.h"
#include "cli/stop_signal.h"
#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/stop.h"
#include "core/image/preview.h"
#include "core/sensor/development.h"
#include "dataset/formats/clean_film.h"
#include "dataset/set/point_seeds.h"
#include "dataset/set/view_writer.h"
#include "dataset/set_files.h"
#include "dataset/surface_points.h"
#include "render/image_header.h"

namespace uw {

namespace {

constexpr int k_draft_width = 160;  // of the images that exposures follow from [pixels]
constexpr std::size_t k_most_drafts = 5;

void shrink_to_draft(SceneDesc& scene) {
    CameraDesc& camera = scene.camera;
    scene.render.quality = RenderDesc::Quality::draft;
    scene.render.samples = 1;
    if (camera.width <= k_draft_width) return;
    const double height = static_cast<double>(camera.height) * k_draft_width / camera.width;
    resize_image(camera, k_draft_width, std::max(1, static_cast<int>(std::lround(height))));
}

}  // namespace

ViewRenderer::ViewRenderer(const DatasetArguments& arguments, std::size_t count)
    : arguments_(arguments),
      count_(count),
      progress_("views", "views", static_cast<double>(count), arguments.image.quiet),
      renderer_(
          [this](const std::string& stage, double fraction) { return proceed(stage, fraction); }) {}

ViewRenderer::~ViewRenderer() = default;

bool ViewRenderer::proceed(const std::string& stage, double fraction) {
    // Of a view's time nearly all is this stage.
    const double share = stage == "render" ? fraction : 0;
    progress_.update((static_cast<double>(rendered_) + share) / static_cast<double>(count_));
    return !stop_requested();
}

void ViewRenderer::warn(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings)
        if (warned_.insert(warning).second) {
            progress_.end_line();
            print_message(fmt::format("warning: {}\n", warning));
        }
}

Exposures ViewRenderer::exposures_of(const DatasetDefinition& definition, const SceneDesc& scene) {
    const StopScope scope(stop_flag());
    const bool with_clean = definition.has_format("clean");
    const std::string layers = with_clean ? "clean" : "depth";
    const std::size_t views = definition.frames.size() * definition.cameras.size();
    const std::size_t drafts = std::min(views, k_most_drafts);
    std::optional<double> least, least_clean;  // none: all black so far
    const auto take = [](std::optional<double>& least_so_far, const Film& film) {
        if (const auto exposure = automatic_exposure(film))
            least_so_far = std::min(*exposure, least_so_far.value_or(*exposure));
    };
    for (std::size_t i = 0; i < drafts; ++i) {
        const std::size_t index = drafts > 1 ? i * (views - 1) / (drafts - 1) : 0;
        ResolvedScene draft(
            scene_of_image(scene, choice_of(definition, scene, definition.view(index))));
        shrink_to_draft(draft.edit());
        renderer_.set_scene(std::move(draft));
        const Film& film = renderer_.render({.layers = layers});
        take(least, film);
        if (with_clean)
            take(least_clean,
                 clean_film(film, layer_plan(renderer_.scene(), layers),
                            renderer_.scene().render.colour, renderer_.scene().water.bands_nm));
    }
    return {least.value_or(1), least_clean.value_or(1)};
}

void ViewRenderer::load_points(const DatasetFile& set, std::size_t draw, const SceneDesc& scene) {
    const DatasetDefinition& definition = set.definition;
    if (!needs_points(definition) || (points_ && draw_of_points_ == draw)) return;
    const std::string name = points_file(definition, draw);
    const std::filesystem::path& folder = arguments_.image.output;
    std::error_code error;
    if (!std::filesystem::exists(folder / name, error)) {
        renderer_.set_scene(scene_of_image(scene, choice_of(definition, scene, {draw, 0, 0})));
        SetFiles(folder).add_bytes(
            "points", name,
            points_csv(point_seeds(definition, draw, scene, *renderer_.assemble().surfaces)));
    }
    points_ = std::make_shared<const std::vector<SurfacePoint>>(read_points(folder / name));
    draw_of_points_ = draw;
}

void ViewRenderer::render(const DatasetFile& set, const View& view, const SceneDesc& scene) {
    const StopScope scope(stop_flag());
    const DatasetDefinition& definition = set.definition;
    load_points(set, view.draw, scene);
    const std::optional<int> number = definition.frames[view.frame];
    RenderOptions options{.layers = layers_of(definition), .frame = number.value_or(0)};
    renderer_.set_scene(scene_of_image(scene, choice_of(definition, scene, view)));
    const std::optional<SensorDesc> sensor = renderer_.scene().camera.sensor;
    if (sensor) options.layers += ",sensor";
    renderer_.render(options);
    warn(renderer_.report().warnings);
    const SceneDesc& rendered = renderer_.scene();
    const double time = rendered.time ? *rendered.time : number.value_or(0) / rendered.render.fps;
    auto images = std::make_shared<ViewImages>(ViewImages{
        definition, view, time, rendered.camera, rendered.render.colour, rendered.water.bands_nm,
        renderer_.release_film(), layer_plan(rendered, options.layers), std::nullopt, set.exposures,
        metadata_of(renderer_.assembled(), number, options.paths, renderer_.report()),
        renderer_.assembled().surfaces, points_});
    if (sensor) images->sensor = Development(*sensor)(images->film, images->film.window());
    finish();
    ++rendered_;
    const std::size_t bytes = images->film.values().size_bytes();
    writing_ = std::make_unique<BackgroundTask>(
        [images = std::move(images), folder = arguments_.image.output, sum = sum_of(definition)] {
            write_view(folder, sum, *images);
        });
    if (2 * bytes > available_memory_bytes()) finish();
}

void ViewRenderer::finish() {
    if (!writing_) return;
    const std::unique_ptr<BackgroundTask> writing = std::move(writing_);
    writing->finish();
    ++done_;
}

}  // namespace uw
