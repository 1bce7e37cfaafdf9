#include "cli/render/dataset_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "camera/camera.h"
#include "cli/console.h"
#include "cli/process.h"
#include "cli/render/dataset_arguments.h"
#include "cli/render/frame_sequence.h"
#include "cli/render/image_output.h"
#include "cli/render/run_stats.h"
#include "cli/render/slurm_jobs.h"
#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/output_files.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/image/development.h"
#include "core/image/pixel_image.h"
#include "dataset/completion.h"
#include "dataset/data_card.h"
#include "dataset/definition.h"
#include "dataset/formats.h"
#include "dataset/set_files.h"
#include "dataset/surface_points.h"
#include "dataset/view.h"
#include "render/image_header.h"
#include "render/image_scene.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

/// When the inputs of views were written last.
class InputTimes {
  public:
    InputTimes(const DatasetArguments& arguments, const DatasetDefinition& definition)
        : arguments_(arguments), definition_(definition) {}

    fs::file_time_type last_change(const View& view) {
        if (!view_ || view_->draw != view.draw)
            scene_ = scene_of_draw(arguments_, definition_.draws[view.draw]);
        const bool is_known = view_ && view_->draw == view.draw && view_->frame == view.frame;
        view_ = view;
        if (is_known) return last_;
        last_ = fs::file_time_type::min();
        const ImageChoice choice = choice_of(definition_, scene_, view);
        for (const InputFile& input : input_files(scene_, choice, known_)) {
            std::error_code error;
            const auto written = fs::last_write_time(input.file, error);
            if (!error && !input.is_hashed) last_ = std::max(last_, written);
        }
        return last_;
    }

  private:
    const DatasetArguments& arguments_;
    const DatasetDefinition& definition_;
    SceneDesc scene_;
    std::optional<View> view_;  // the last asked for
    fs::file_time_type last_;
    MeshSideFiles known_;
};

}  // namespace

std::vector<std::size_t> missing_views(const DatasetArguments& arguments,
                                       const DatasetDefinition& definition, ViewRange range) {
    const fs::path& folder = arguments.image.output;
    const std::string sum = sum_of(definition);
    std::vector<char> is_there(range.end - range.begin);
    parallel_for(is_there.size(), [&](std::size_t i) {
        const View view = definition.view(range.begin + i);
        is_there[i] = is_view_complete(folder, definition, sum, view) ? 1 : 0;
    });
    InputTimes inputs(arguments, definition);
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < is_there.size(); ++i) {
        const View view = definition.view(range.begin + i);
        std::error_code error;
        if (is_there[i] == 0 || fs::last_write_time(folder / record_file(definition, view), error) <
                                    inputs.last_change(view))
            missing.push_back(range.begin + i);
    }
    return missing;
}

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
        renderer_.set_scene(
            scene_of_image(scene, choice_of(definition, scene, definition.view(index)))
                .with(shrink_to_draft));
        const Film& film = renderer_.render({.layers = layers});
        take(least, film);
        if (with_clean)
            take(least_clean, clean_film(film, layer_plan(renderer_.scene(), layers),
                                         renderer_.scene().desc().render.colour,
                                         renderer_.scene().desc().water.bands_nm));
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
    const std::optional<SensorDesc> sensor = renderer_.scene().desc().camera.sensor;
    if (sensor) options.layers += ",sensor";
    renderer_.render(options);
    warn(renderer_.report().warnings);
    const SceneDesc& rendered = renderer_.scene().desc();
    const double time = renderer_.scene().time().value_or(number.value_or(0) / rendered.render.fps);
    auto images = std::make_shared<ViewImages>(
        ViewImages{definition, view, time, rendered.camera, rendered.render.colour,
                   rendered.water.bands_nm, renderer_.release_film(),
                   layer_plan(renderer_.scene(), options.layers), std::nullopt, set.exposures,
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

namespace {

void complete(const fs::path& folder, const DatasetFile& set, bool check, bool quiet) {
    begin_orderly_stop();
    try {
        const StopScope scope(stop_flag());
        Progress progress("completing the set", "", 1, quiet);
        complete_dataset(folder, set, check, [&](double share) {
            progress.update(share);
            return !stop_requested();
        });
    } catch (const Interrupted&) {
        throw Interrupted("interrupted; the views are there, --merge completes the set");
    }
    if (!quiet)
        print_message(
            fmt::format("{}: complete, {} views\n", folder.string(), set.definition.view_count()));
}

void merge(const DatasetArguments& a) {
    const auto refuse = [](bool is_given, const char* option) {
        if (is_given)
            throw UsageError(fmt::format(
                "{}: --merge takes everything from the set in its folder; leave it out", option));
    };
    refuse(!a.image.scene.empty(), "SCENE");
    refuse(!a.image.output.empty(), "-o");
    refuse(!a.formats.empty(), "--format");
    refuse(a.shard.has_value(), "--shard");
    refuse(a.slurm_tasks.has_value(), "--slurm");
    const auto set = read_dataset_file(a.merge);
    if (!set)
        throw IoError(fmt::format("{}: no data set is there; give the folder of its shards",
                                  printable(a.merge.string(), 300)));
    complete(a.merge, *set, true, a.image.quiet);
}

/// Checks before the work that the scene can be rendered in all frames and written in all formats.
void check(const DatasetDefinition& definition, const SceneDesc& scene) {
    FrameSequence sequence;
    for (const std::optional<int>& frame : definition.frames)
        sequence.frames.push_back({frame, {}, 0, "", {}, {}});
    check_frames(sequence, [&](std::optional<int>) -> const SceneDesc& { return scene; });
    const ImageScene first = scene_of_image(scene, choice_of(definition, scene, {}));
    for (const std::string& name : definition.formats)
        if (const auto check = dataset_format(name).check) check(definition, first.desc());
    layer_plan(first, layers_of(definition));  // throws for what does not exist
    const auto refuse_jpeg = [](const CameraDesc& camera) {
        if (camera.sensor && camera.sensor->image.format == DevelopmentDesc::Format::jpeg)
            throw UsageError(
                "camera.sensor.image.format: the images of data sets are PNG; give --set "
                "camera.sensor.image.format=png");
    };
    refuse_jpeg(scene.camera);
    for (const RigCameraDesc& entry : scene.cameras) refuse_jpeg(entry.camera);
}

class DatasetRun {
  public:
    explicit DatasetRun(const DatasetArguments& arguments) : a_(arguments) {
        if (a_.image.scene.empty())
            throw UsageError("SCENE: is missing; give a scene file, or --merge FOLDER");
        if (a_.slurm_tasks && a_.shard)
            throw UsageError("--shard: the tasks of --slurm render all of them; leave it out");
        if (a_.image.output.empty()) a_.image.output = a_.image.scene.stem().string() + "-dataset";
    }

    void run() {
        std::vector<std::vector<std::string>> draws =
            draws_of(a_, !read_dataset_file(a_.image.output));
        scene_ = scene_of_draw(a_, draws.front());
        DatasetDefinition wanted = definition_of(a_, scene_);
        wanted.draws = std::move(draws);
        check(wanted, scene_);
        begin_orderly_stop();  // or temporary files might stay
        const StopScope scope(stop_flag());
        begin(wanted);
        if (a_.slurm_tasks)
            submit();
        else
            render_shard(a_.shard.value_or(ShardArgument{}));
    }

  private:
    void render_shard(const ShardArgument& shard) {
        const ViewRange range = shard_of(set_.definition, shard.number, shard.count);
        const std::vector<std::size_t> missing = look_for_missing(range);
        if (!a_.image.quiet && missing.size() < range.end - range.begin)
            print_message(fmt::format("{} of {} views are there already\n",
                                      range.end - range.begin - missing.size(),
                                      range.end - range.begin));
        render(missing);
        if (shard.count == 1) complete(a_.image.output, set_, false, a_.image.quiet);
    }

    std::vector<std::size_t> look_for_missing(ViewRange range) const {
        try {
            return missing_views(a_, set_.definition, range);
        } catch (const Interrupted&) {
            throw Interrupted("interrupted; the same command continues");
        }
    }

    /// Renders the first moments here to learn what the others take, and leaves those to a cluster.
    void submit() {
        const DatasetDefinition& d = set_.definition;
        const std::size_t cameras = d.cameras.size();
        std::vector<std::size_t> views;
        for (std::size_t view = 0; view < std::min(2 * cameras, d.view_count()); ++view)
            views.push_back(view);
        SlurmRequest request;
        MeasuredWork& measured = request.measured;
        render(views);
        const auto seconds = [](auto from, auto to) {
            return std::chrono::duration<double>(to - from).count();
        };
        measured.first_seconds = seconds(start_, ends_[cameras - 1]);
        measured.next_seconds = views.size() > cameras ? seconds(ends_[cameras - 1], ends_.back())
                                                       : measured.first_seconds;
        measured.memory_bytes = RunStats::peak_memory_bytes();
        measured.threads = permitted_threads();
        const auto record = read_record(a_.image.output, d, sum_of(d), d.view(0));
        for (const SetFile& file : record.value().files)
            measured.moment_bytes += cameras * file.bytes;
        request.folder = fs::absolute(a_.image.output).lexically_normal();
        request.name = request.folder.filename().string();
        request.working = fs::current_path();
        const std::string program = shell_word(fs::read_symlink("/proc/self/exe").string());
        const std::string folder = shell_word(request.folder.string());
        request.command = program + " dataset " +
                          shell_word(fs::absolute(a_.image.scene).string()) + " -o " + folder +
                          set_options(a_, d);
        request.merge_command = program + " dataset --merge " + folder;
        request.options = a_.slurm_options;
        request.tasks = *a_.slurm_tasks;
        request.moments = d.view_count() / cameras;
        write_jobs(request);
        if (!a_.image.quiet)
            print_message(fmt::format("{} tasks of {} minutes, {} threads and {} MB: {}\n",
                                      request.tasks, task_minutes(request), measured.threads,
                                      task_megabytes(request),
                                      jobs_folder(request.folder).string()));
        if (!a_.slurm_dry_run) print_message(submit_jobs(request) + "\n");
    }

    /// Continues the set that is in the folder, or begins it.
    void begin(const DatasetDefinition& wanted) {
        const fs::path& folder = a_.image.output;
        if (auto there = read_dataset_file(folder)) {
            check_same_set(folder, there->definition, wanted);
            set_ = std::move(*there);
            return;
        }
        const AtomicFile probe(folder / k_dataset_file);  // before the work rather than after it
        set_.definition = wanted;
        const ImageChoice first = choice_of(set_.definition, scene_, {});
        if (const auto& exposure = set_.definition.exposure)
            set_.exposures = {*exposure, *exposure};
        else
            set_.exposures = ViewRenderer(a_, 1).exposures_of(set_.definition, scene_);
        set_.facts = facts_of(scene_of_image(scene_, first).desc());
        {
            const FolderLock lock(folder);  // of several that begin at once, one says what it is
            if (!read_dataset_file(folder))
                SetFiles(folder).add_bytes("set", k_dataset_file, dataset_text(set_));
        }
        // What is read again is what all others read.
        set_ = read_dataset_file(folder).value();
        check_same_set(folder, set_.definition, wanted);
    }

    void render(const std::vector<std::size_t>& views) {
        if (views.empty()) return;
        ViewRenderer renderer(a_, views.size());
        try {
            for (const std::size_t index : views) {
                const View view = set_.definition.view(index);
                load_draw(view.draw);
                renderer.render(set_, view, scene_);
                ends_.push_back(std::chrono::steady_clock::now());
            }
            renderer.finish();
        } catch (const Interrupted&) {
            try {
                renderer.finish();
            } catch (const Interrupted&) {
                // It was being written, and is not done.
            }
            throw Interrupted(
                fmt::format("interrupted; {} of {} views are done; the same command "
                            "continues",
                            renderer.done(), views.size()));
        }
    }

    void load_draw(std::size_t draw) {
        if (draw == draw_) return;
        scene_ = scene_of_draw(a_, set_.definition.draws[draw]);
        draw_ = draw;
    }

    DatasetArguments a_;
    SceneDesc scene_;  // of the draw
    std::size_t draw_ = 0;
    DatasetFile set_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::vector<std::chrono::steady_clock::time_point> ends_;  // of the views rendered
};

}  // namespace

void run_dataset(const DatasetArguments& a) {
    const ThreadLimit limit(a.image.threads);
    if (!a.merge.empty())
        merge(a);
    else
        DatasetRun(a).run();
}

Command dataset_command() {
    const auto arguments = std::make_shared<DatasetArguments>();
    return {"dataset", "render a data set with ground truth, in the formats of other tools",
            dataset_examples(), dataset_options(*arguments), [arguments] {
                install_stop_signal();
                run_dataset(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
