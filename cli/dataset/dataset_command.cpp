#include "cli/dataset/dataset_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "cli/console.h"
#include "cli/dataset/dataset_options.h"
#include "cli/dataset/missing_views.h"
#include "cli/dataset/set_definition.h"
#include "cli/dataset/slurm_jobs.h"
#include "cli/dataset/view_renderer.h"
#include "cli/progress.h"
#include "cli/render/frame_check.h"
#include "cli/render/stats.h"
#include "cli/stop_signal.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/stop.h"
#include "core/base/text.h"
#include "core/files/atomic_file.h"
#include "core/files/folder_lock.h"
#include "dataset/formats/format_table.h"
#include "dataset/set/completion.h"
#include "dataset/set/data_card.h"
#include "dataset/set/dataset_file.h"
#include "dataset/set/point_seeds.h"
#include "dataset/set/view_writer.h"
#include "dataset/set_files.h"
#include "dataset/view_record.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

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
    const ResolvedScene first(scene_of_image(scene, choice_of(definition, scene, {})));
    for (const std::string& name : definition.formats)
        if (const auto check = dataset_format(name).check) check(definition, first.desc());
    layer_plan(first.desc(), layers_of(definition));  // throws for what does not exist
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
        set_.facts = facts_of(ResolvedScene(scene_of_image(scene_, first)).desc());
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
