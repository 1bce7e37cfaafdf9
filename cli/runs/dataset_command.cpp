#include "cli/runs/dataset_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "cli/console.h"
#include "cli/process.h"
#include "cli/render/run_stats.h"
#include "cli/runs/dataset_arguments.h"
#include "cli/runs/slurm_jobs.h"
#include "core/base/error.h"
#include "core/base/output_files.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/image/colour_view.h"
#include "core/image/pixel_image.h"
#include "core/image/preview_exposure.h"
#include "dataset/completion.h"
#include "dataset/data_card.h"
#include "dataset/definition.h"
#include "dataset/formats.h"
#include "dataset/frame_stamps.h"
#include "dataset/input_summing.h"
#include "dataset/pinhole_fit.h"
#include "dataset/set_files.h"
#include "dataset/surface_points.h"
#include "dataset/view.h"
#include "render/image_scene.h"
#include "render/light_left_out.h"
#include "render/run/draft.h"
#include "render/run/job.h"
#include "render/run/run_engine.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

/// The view of pictures; null: sRGB. A set's bytes follow from the scene and its files, whatever
/// the environment of the process that renders a part of it.
std::shared_ptr<const ColourView> view_of(const RenderDesc& render) {
    if (!render.view) return nullptr;
    if (render.view->config.empty())
        throw InputError(render.view->where +
                         ": a data set does not depend on the environment; add config: FILE.ocio");
    return colour_view(render.view);
}

constexpr int k_draft_width = 160;  // of the images that exposures follow from [pixels]
constexpr std::size_t k_max_drafts = 5;

/// Base of the classes that process views of a data set and show their progress.
class ViewClient : public RunClient {
  public:
    ViewClient(std::size_t count, ProgressForm form)
        : progress_("views", "views", static_cast<double>(count), form) {}

    void tell(Stage stage, double fraction) override {
        // Nearly all the time that a view takes is this stage.
        const double rendered = stage == Stage::render ? fraction : 0;
        // Computing species may take longer than all views.
        progress_.update(
            engine_.clock().progress(rendered),
            stage == Stage::particles ? fmt::format("particles: {:.0f} %", 100 * fraction) : "");
    }

  protected:
    RunEngine engine_;
    Progress progress_;
};

/// Looks at small drafts of a few views before the set is begun: for the exposures that bring the
/// brightest to a good brightness, and for the light that the images leave out.
class FirstLook : public ViewClient {
  public:
    /// The exposures follow from the first `for_exposure` of the views.
    FirstLook(const DatasetDefinition& definition, std::size_t for_exposure, std::size_t views,
              ProgressForm progress)
        : ViewClient(views, progress),
          with_clean_(definition.has_format("clean")),
          for_exposure_(for_exposure) {}

    void look(const Job& job) { engine_.run(job, *this); }

    Exposures exposures() const { return {image_.value_or(1), clean_.value_or(1)}; }
    /// The light that each view leaves out; a view that is rendered with all light has no entry.
    const std::vector<LightLeftOut>& left_out() const { return left_out_; }

    WantedImage want(std::size_t /*place*/, ImageScene& scene) override {
        scene =
            draft_of(scene, k_draft_width).with([](SceneDesc& desc) { desc.render.samples = 1; });
        return {{.layers = with_clean_ ? "clean" : "depth"}};
    }

    ImageWork take(std::size_t place, FinishedImage image) override {
        if (const auto left_out = engine_.renderer().light_left_out())
            left_out_.push_back(*left_out);
        if (place >= for_exposure_) return {};
        lower(image_, image.film);
        const SceneDesc& scene = engine_.renderer().scene().desc();
        if (with_clean_)
            lower(clean_,
                  clean_film(image.film, image.plan, scene.render.colour, scene.water.bands_nm));
        return {};
    }

    void warn(std::size_t /*place*/, const std::string& /*line*/) override {
        // Rendering the views themselves will give the warnings.
    }

  private:
    static void lower(std::optional<double>& least, const Film& film) {
        if (const auto exposure = automatic_exposure(film))
            least = std::min(*exposure, least.value_or(*exposure));
    }

    bool with_clean_;
    std::size_t for_exposure_;
    std::optional<double> image_, clean_;  // the least so far; none: all black
    std::vector<LightLeftOut> left_out_;
};

bool has_port(const SceneDesc& scene) {
    return scene.camera.port.has_value() ||
           std::ranges::any_of(scene.cameras, [](const RigCameraDesc& entry) {
               return entry.camera.port.has_value();
           });
}

/// Renders views of a data set, and has them written.
class ViewRenderer : public ViewClient {
  public:
    /// `views`: their indices in the set.
    ViewRenderer(const DatasetArguments& arguments, const DatasetFile& set,
                 const std::vector<std::size_t>& views)
        : ViewClient(views.size(), arguments.image.progress),
          folder_(arguments.image.output),
          set_(set),
          sum_(sum_of(set.definition)),
          views_(views),
          quiet_(arguments.image.quiet) {}

    /// Throws InputError; IoError; Interrupted, and then all views that were written are whole.
    void run(const Job& job) {
        scenes_ = &job.scenes;
        try {
            engine_.run(job, *this);
        } catch (const Interrupted&) {
            throw Interrupted(fmt::format(
                "interrupted; {} of {} {} done; the same command continues", engine_.written(),
                counted(views_.size(), "view"), engine_.written() == 1 ? "is" : "are"));
        }
    }

    /// When each view was rendered.
    const std::vector<std::chrono::steady_clock::time_point>& ends() const { return ends_; }

    WantedImage want(std::size_t place, ImageScene& scene) override {
        load_draw(set_.definition.view(views_[place]).draw);
        inputs_ = summer_.sums_of(scene.whole(), scene.choice());
        const bool has_sensor = scene.desc().camera.sensor.has_value();
        return {{.layers = layers_of(set_.definition) + (has_sensor ? ",sensor" : "")}, has_sensor};
    }

    ImageWork take(std::size_t place, FinishedImage image) override {
        const DatasetDefinition& definition = set_.definition;
        const View view = definition.view(views_[place]);
        const ImageScene& rendered = engine_.renderer().scene();
        const SceneDesc& scene = rendered.desc();
        const std::optional<int> frame = definition.frames[view.frame];
        const double time = rendered.time().value_or(frame.value_or(0) / scene.render.fps);
        const auto images = std::make_shared<ViewImages>(ViewImages{
            definition, view, time, stamps_.value().at(frame, time), scene.camera,
            scene.render.colour, scene.water.bands_nm, std::move(image.film), image.plan,
            std::move(image.sensor), set_.exposures, view_of(scene.render),
            std::move(image.metadata), image.surfaces, points_, std::move(inputs_), shared_});
        ends_.push_back(std::chrono::steady_clock::now());
        return {[this, images] { write_view(folder_, sum_, *images); }};
    }

    void warn(std::size_t /*place*/, const std::string& line) override {
        progress_.end_line();
        print_message(fmt::format("warning: {}\n", line));
    }

  private:
    /// Finds the data common to a draw's views (surface points, sensors, pinholes), and writes them
    /// unless another process has. Existing files may be of other meshes.
    void load_draw(std::size_t draw) {
        if (draw_ == draw) return;
        draw_ = draw;
        shared_.clear();
        const DatasetDefinition& definition = set_.definition;
        const SceneDesc& scene = scenes_->of(static_cast<int>(draw));
        stamps_.emplace(scene);
        if (needs_points(definition)) {
            const std::string name = points_file(definition, draw);
            share("points", name,
                  points_csv(point_seeds(definition, draw, scene, surfaces_of(draw))));
            points_ = std::make_shared<const std::vector<Landmark>>(read_points(folder_ / name));
        }
        for (const std::string& format : definition.formats)
            if (const auto files = dataset_format(format).share)
                for (const NamedText& file : files(definition, draw, scene))
                    share("sensors", file.name, file.text);
        const bool knows_ports =
            fittable_formats(definition).empty() && formats_in_air(definition).empty();
        if (knows_ports || !has_port(scene)) return;
        const PinholeFits fits = fit_pinholes(definition, draw, scene, surfaces_of(draw));
        share("pinholes", pinhole_file(definition, draw), pinhole_text(fits));
        if (!std::exchange(has_told_of_pinholes_, true)) tell_of_pinholes(fits);
    }

    /// Writes a file that is common to a draw's views unless it exists with these contents.
    void share(const char* role, const std::string& name, const std::string& text) {
        const SetFile file{role, name, text.size(), sha256_of(text)};
        if (!is_whole(folder_, file, true)) SetFiles(folder_).add_bytes(role, name, text);
        shared_.push_back(file);
    }

    /// The surfaces of a draw's first frame.
    const Surfaces& surfaces_of(std::size_t draw) {
        const SceneDesc& scene = scenes_->of(static_cast<int>(draw));
        engine_.renderer().set_scene(
            scene_of_image(scene, choice_of(set_.definition, scene, {draw, 0, 0})));
        return *engine_.renderer().assemble().surfaces;
    }

    void tell_of_pinholes(const PinholeFits& fits) {
        const DatasetDefinition& definition = set_.definition;
        const std::string fittable = fittable_formats(definition);
        if (definition.pinhole_fit && !quiet_) say("note", fitted_message(fittable, fits));
        say("warning", in_air_message(formats_in_air(definition), fittable, fits));
    }

    void say(const char* kind, const std::string& line) {
        if (line.empty()) return;
        progress_.end_line();
        print_message(fmt::format("{}: {}\n", kind, line));
    }

    const fs::path& folder_;
    const DatasetFile& set_;
    std::string sum_;
    const std::vector<std::size_t>& views_;
    bool quiet_;
    JobScenes* scenes_ = nullptr;
    std::vector<std::chrono::steady_clock::time_point> ends_;
    std::optional<std::size_t> draw_;                      // that of the last view
    std::optional<FrameStamps> stamps_;                    // of it
    std::shared_ptr<const std::vector<Landmark>> points_;  // of it; null: none are needed
    std::vector<SetFile> shared_;                          // of it
    bool has_told_of_pinholes_ = false;
    InputSummer summer_;
    InputSums inputs_;  // of the image that is being rendered
};

}  // namespace

namespace {

void complete(const fs::path& folder, const DatasetFile& set, bool check,
              const RenderArguments& arguments) {
    begin_orderly_stop();
    try {
        const StopScope scope(stop_flag());
        Progress progress("completing the set", "", 1, arguments.progress);
        complete_dataset(folder, set, check, [&](double fraction) { progress.update(fraction); });
    } catch (const Interrupted&) {
        throw Interrupted("interrupted; the views are there, --merge completes the set");
    }
    if (!arguments.quiet)
        print_message(fmt::format("{}: complete, {}\n", folder.string(),
                                  counted(set.definition.view_count(), "view")));
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
    complete(a.merge, *set, true, a.image);
}

void check_pinhole_fit(const DatasetDefinition& definition, const SceneDesc& scene) {
    if (fittable_formats(definition).empty())
        throw UsageError(
            "--pinhole-fit: is for the cameras of colmap, nerfstudio, euroc and mcap; add one of "
            "them "
            "to --format");
    if (!has_port(scene))
        throw UsageError("--pinhole-fit: no camera of the scene has a port; leave it out");
}

/// Checks before the work that the first draw can be rendered in all frames and all draws written
/// in all formats.
void check(const DatasetDefinition& definition, JobScenes& scenes) {
    Job job{scenes, {}};
    for (const std::optional<int>& frame : definition.frames) job.images.push_back({0, {frame, 0}});
    check_inputs(job);
    const SceneDesc& scene = scenes.of(0);
    const ImageScene first = scene_of_image(scene, choice_of(definition, scene, {}));
    if (definition.pinhole_fit) check_pinhole_fit(definition, first.desc());
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

/// "3 of 7 views are there already".
std::string there_text(std::size_t all, std::size_t missing) {
    return fmt::format("{} of {} {} there already\n", all - missing, counted(all, "view"),
                       all - missing == 1 ? "is" : "are");
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
        draws_ = draws_of(a_, !read_dataset_file(a_.image.output));
        view_of(scenes_.of(0).render);  // throws before anything is rendered
        DatasetDefinition wanted = definition_of(a_, scenes_.of(0));
        wanted.draws = draws_;
        check(wanted, scenes_);
        for (std::size_t camera = 0; camera < wanted.cameras.size(); ++camera)
            cameras_.push_back(choice_of(wanted, scenes_.of(0), {0, 0, camera}).camera);
        begin_orderly_stop();  // or temporary files might stay
        const StopScope scope(stop_flag());
        begin(wanted);
        const std::string light = light_note(set_);
        if (!light.empty() && !a_.image.quiet) print_message(fmt::format("note: {}\n", light));
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
            print_message(there_text(range.end - range.begin, missing.size()));
        render(missing);
        if (shard.count == 1) complete(a_.image.output, set_, false, a_.image);
    }

    std::vector<std::size_t> look_for_missing(ViewRange range) {
        try {
            return missing_views(range);
        } catch (const Interrupted&) {
            throw Interrupted("interrupted; the same command continues");
        }
    }

    /// The views of `range` that are to be rendered, by their indices: those that are not there
    /// whole, and those that were rendered from input files with another content. Inputs that are
    /// part of the scene's hash are part of the definition.
    std::vector<std::size_t> missing_views(ViewRange range) {
        const DatasetDefinition& definition = set_.definition;
        const fs::path& folder = a_.image.output;
        const std::string sum = sum_of(definition);
        std::vector<std::optional<InputSums>> made_of(range.end - range.begin);
        parallel_for(made_of.size(), [&](std::size_t i) {
            const View view = definition.view(range.begin + i);
            if (auto record = complete_record(folder, definition, sum, view))
                made_of[i] = std::move(record->inputs);
        });
        InputSummer summer;
        std::vector<std::size_t> missing;
        for (std::size_t i = 0; i < made_of.size(); ++i) {
            const JobImage image = image_of(definition.view(range.begin + i));
            if (!made_of[i] || *made_of[i] != summer.sums_of(scenes_.of(image.scene), image.choice))
                missing.push_back(range.begin + i);
        }
        return missing;
    }

    JobImage image_of(const View& view) const {
        return {static_cast<int>(view.draw),
                {set_.definition.frames[view.frame], cameras_[view.camera]}};
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
        const auto ends = render(views);
        const auto seconds = [](auto from, auto to) {
            return std::chrono::duration<double>(to - from).count();
        };
        measured.first_seconds = seconds(start_, ends[cameras - 1]);
        measured.next_seconds = views.size() > cameras ? seconds(ends[cameras - 1], ends.back())
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
            print_message(
                fmt::format("{} of {}, {} and {} MB: {}\n",
                            counted(static_cast<std::size_t>(request.tasks), "task"),
                            counted(static_cast<std::size_t>(task_minutes(request)), "minute"),
                            counted(static_cast<std::size_t>(measured.threads), "thread"),
                            task_megabytes(request), jobs_folder(request.folder).string()));
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
        look_first();
        {
            const FolderLock lock(folder);  // of several that begin at once, one defines the set
            if (!read_dataset_file(folder))
                SetFiles(folder).add_bytes("set", k_dataset_file, dataset_text(set_));
        }
        // Read it again, as all other processes do.
        set_ = read_dataset_file(folder).value();
        check_same_set(folder, set_.definition, wanted);
    }

    /// Finds the exposures and facts of a new set at a few views of the first draw, one if the
    /// exposure is given, and one view of a few other draws.
    void look_first() {
        const DatasetDefinition& definition = set_.definition;
        const std::size_t views = definition.frames.size() * definition.cameras.size();
        const std::size_t of_first = definition.exposure ? 1 : std::min(views, k_max_drafts);
        Job job{scenes_, {}};
        for (std::size_t i = 0; i < of_first; ++i) {
            const std::size_t index = of_first > 1 ? i * (views - 1) / (of_first - 1) : 0;
            job.images.push_back(image_of(definition.view(index)));
        }
        const std::size_t draws = std::min(definition.draws.size(), k_max_drafts);
        for (std::size_t i = 1; i < draws; ++i)
            job.images.push_back(image_of({i * (definition.draws.size() - 1) / (draws - 1), 0, 0}));
        FirstLook first(definition, of_first, job.images.size(), a_.image.progress);
        first.look(job);
        if (const auto& exposure = definition.exposure)
            set_.exposures = {*exposure, *exposure};
        else
            set_.exposures = first.exposures();
        set_.facts = facts_of(scenes_.look_at(image_of({})).desc(), first.left_out());
    }

    /// When each of the views was rendered.
    std::vector<std::chrono::steady_clock::time_point> render(
        const std::vector<std::size_t>& views) {
        if (views.empty()) return {};
        Job job{scenes_, {}};
        for (const std::size_t index : views)
            job.images.push_back(image_of(set_.definition.view(index)));
        ViewRenderer renderer(a_, set_, views);
        renderer.run(job);
        return renderer.ends();
    }

    DatasetArguments a_;
    std::vector<std::vector<std::string>> draws_;
    JobScenes scenes_{
        [this](int draw) { return scene_of_draw(a_, draws_[static_cast<std::size_t>(draw)]); }};
    DatasetFile set_;
    std::vector<std::size_t> cameras_;  // of the set, by their places in the scene
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
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
