#include "cli/runs/sweep_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

#include "cli/console.h"
#include "cli/image_choice.h"
#include "cli/number_range.h"
#include "cli/process.h"
#include "cli/render/picture_numbers.h"
#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/scene/key_path.h"
#include "core/scene/render_desc.h"
#include "render/run/draft.h"
#include "render/run/run_engine.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

constexpr double k_max_axis_values = 1000;

}  // namespace

std::optional<ValueAxis> sweep_axis(const std::string& override) {
    const std::size_t equals = end_of_path(override);
    if (equals == std::string::npos) return std::nullopt;
    const auto range = number_range_in(std::string_view(override).substr(equals + 1));
    if (!range) return std::nullopt;
    const auto fail = [&](const char* what) {
        throw UsageError(fmt::format("--set {}: {}", printable(override, 200), what));
    };
    if (range->step == 0) fail("the step is 0; give FIRST:LAST:STEP, such as -1.2:-0.2:0.2");
    const double count = range->count();
    if (count > k_max_axis_values) fail("more than 1000 values; give a larger step");
    if (count < 2) fail("the step is larger than the range; give a smaller one");
    ValueAxis axis{override.substr(0, equals), {}};
    for (int i = 0; i < static_cast<int>(count); ++i) {
        // Rounded to the decimal number that is meant: 0.3, not 0.30000000000000004.
        double value = 0;
        parse_number(fmt::format("{:.12g}", range->at(i)), value);
        axis.values.push_back(value);
    }
    return axis;
}

const char* const k_sweep_examples = R"(Examples:
  uwvdb sweep plume.yaml --set 'lamps.left.position[0]=-1.2:-0.2:0.2'
  uwvdb sweep plume.yaml --set 'lamps.left.position[0]=-1.5:-0.1:0.1' --target 3 -o out/distance.csv
  uwvdb sweep stereo.yaml --camera left --set 'lamps.port.position[0]=-1.2:-0.2:0.2' \
      --with 'lamps.starboard.position[0]=1.2:0.2:0.2'
  uwvdb sweep plume.yaml --set 'lamps.left.position[0]=-1.2:-0.2:0.2' \
      --set water.particles.large=0.1:1:0.3 --object seabed

Renders the scene as a draft for each value from FIRST to LAST in steps of STEP, of a second --set
for each pair, and measures it: signal, backscatter, contrast, evenness (docs/edit.md). Other
values of --set are the same for all. Writes OUT.csv, a row for each picture and part of it, and
OUT.svg, plots of contrast and signal to backscatter. Ctrl-C keeps what has been measured.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write,
130 interrupted.)";

Options sweep_options(SweepArguments& a) {
    Options options;
    options.input("SCENE", "", a.scene, "scene file (docs/scene-file.md)").required = true;
    options.output(
        "-o,--output", "OUT.csv", a.output,
        "the table; the plot gets its name with .svg; default: the scene's, with -sweep");
    Option& set = options.parsed(
        "--set", "KEY.PATH=FIRST:LAST:STEP",
        [&a](const std::string& text) {
            if (const auto axis = sweep_axis(text))
                a.grid.axes.push_back(*axis);
            else
                a.overrides.push_back(text);
        },
        "vary a value of the scene file; once or twice; or KEY.PATH=VALUE: replace it");
    set.required = true;
    set.repeatable = true;
    options
        .parsed(
            "--with", "KEY.PATH=FIRST:LAST:STEP",
            [&a](const std::string& text) {
                const auto axis = sweep_axis(text);
                if (!axis)
                    throw UsageError(fmt::format("--with {}: expected KEY.PATH=FIRST:LAST:STEP",
                                                 printable(text, 200)));
                a.grid.companions.push_back(*axis);
            },
            "vary this value along with the first; may be repeated")
        .repeatable = true;
    options.number("--target", "D", a.target, 0, 1000,
                   "measure a black and white target at D metres, too");
    add_part_options(options, a.parts);
    options.text("--camera", "NAME", a.camera, "which camera of a rig");
    options.integer("--frame", "N", a.frame, 0, 999'999'999, "which frame of sequences");
    options.size(a.size, "of the pictures; default: the scene's, or less: 480 pixels wide");
    Option& quality = options.text("--quality", "NAME", a.quality,
                                   "of the pictures: draft, the default, final or exact");
    quality.value = Option::Value::word;
    for (const auto& [word, meaning] : k_quality_names) quality.words.emplace_back(word);
    options.threads(a.threads);
    options.confine();
    options.messages(a.quiet, a.progress);
    return options;
}

void check_axes(const SweepArguments& a) {
    if (a.grid.axes.empty() || a.grid.axes.size() > 2)
        throw UsageError(
            fmt::format("--set: {} values with a range; vary one or two, such as "
                        "lamps.left.position[0]=-1.2:-0.2:0.2",
                        a.grid.axes.size()));
    for (const ValueAxis& companion : a.grid.companions)
        if (companion.values.size() != a.grid.axes.front().values.size())
            throw UsageError(fmt::format(
                "--with {}: has {} values, but {} has {}; give it a step "
                "of as many",
                printable(companion.key, 200), companion.values.size(),
                printable(a.grid.axes.front().key, 200), a.grid.axes.front().values.size()));
    constexpr std::size_t k_max_pictures = 10000;
    if (a.grid.count() > k_max_pictures)
        throw UsageError(fmt::format("--set: {} pictures, more than {}; give larger steps",
                                     a.grid.count(), k_max_pictures));
}

namespace {

constexpr double k_rendering = 0.9;  // of the time that a picture takes
constexpr int k_usual_width = 480;   // of pictures without --size [pixels]

/// The scene at a place of the grid, with pictures as they are requested.
SceneDesc scene_at(const SweepArguments& a, std::size_t place) {
    std::vector<std::string> overrides = a.overrides;
    std::ranges::move(a.grid.overrides_at(place), std::back_inserter(overrides));
    SceneDesc scene = load_scene(a.scene, overrides);
    ImageRequest request;
    request.quality = a.quality;
    request.size = a.size;
    apply_request(request, scene);
    if (a.size) return scene;
    shrink_image(scene.camera, k_usual_width);
    for (RigCameraDesc& entry : scene.cameras) shrink_image(entry.camera, k_usual_width);
    return scene;
}

/// Measures the pictures of a sweep.
class SweepRun : public RunClient {
  public:
    SweepRun(const SweepArguments& arguments, const ProgressCallback& progress)
        : a_(arguments), progress_(progress) {
        sweep_.keys = a_.grid.keys();
    }

    Sweep measure(const Job& job) {
        try {
            engine_.run(job, *this);
            progress_(1);
            sweep_.is_complete = true;
        } catch (const Interrupted&) {
            // The result is what has been measured so far.
        }
        return std::move(sweep_);
    }

    void tell(Stage stage, double fraction) override {
        progress_(engine_.clock().progress(stage == Stage::render ? k_rendering * fraction : 0));
    }

    WantedImage want(std::size_t /*place*/, ImageScene& scene) override {
        scene_ = scene;
        sweep_.width = scene.desc().camera.width;
        sweep_.height = scene.desc().camera.height;
        return {{.layers = layers_to_measure(scene) + (a_.parts.object.empty() ? "" : ",id")}};
    }

    ImageWork take(std::size_t place, FinishedImage image) override {
        const SceneDesc& scene = scene_->desc();
        const std::vector<PicturePart> parts =
            picture_parts(a_.parts, scene, image.surfaces->names(), image.film, image.plan);
        SweepPoint point{
            a_.grid.values_at(place), part_numbers({image.film, image.plan}, parts), {}};
        if (a_.target)
            point.target = target_numbers(probe_.lamps_on_target(*scene_, *a_.target), *a_.target,
                                          scene.water.bands_nm.size(), probe_.options());
        sweep_.points.push_back(std::move(point));
        return {};
    }

    void warn(std::size_t /*place*/, const std::string& line) override {
        sweep_.warnings.push_back(line);
    }

  private:
    const SweepArguments& a_;
    const ProgressCallback& progress_;
    Sweep sweep_;
    std::optional<ImageScene> scene_;  // of the picture
    TargetProbe probe_;
    RunEngine engine_;
};

}  // namespace

Sweep run_pictures(const SweepArguments& a, const ProgressCallback& progress) {
    JobScenes scenes([&a](int place) { return scene_at(a, static_cast<std::size_t>(place)); });
    const ImageChoice choice{a.frame, chosen_camera(a.camera, scenes.of(0).cameras)};
    Job job{scenes, {}};
    for (std::size_t place = 0; place < a.grid.count(); ++place) {
        job.images.push_back({static_cast<int>(place), choice});
        const SceneDesc& scene = scenes.look_at(job.images.back()).desc();
        check_parts(a.parts, scene, {0, 0, scene.camera.width, scene.camera.height});
    }
    return SweepRun(a, progress).measure(job);
}

namespace {

/// A quantity measured at a point, by which a curve is drawn.
struct Quantity {
    std::string label;
    std::function<double(const SweepPoint&)> value;  // NaN: there is none
};

enum class Kind { contrast, ratio, evenness };

double number_of_part(const SweepPoint& point, const std::string& part, Kind kind) {
    const auto found = std::ranges::find(point.parts, part, &PartNumbers::part);
    if (found == point.parts.end()) return std::numeric_limits<double>::quiet_NaN();
    const PictureNumbers& numbers = found->numbers.picture;
    if (kind == Kind::contrast) return numbers.contrast;
    if (kind == Kind::ratio) return numbers.signal_to_backscatter;
    if (!numbers.evenness || numbers.evenness->pixels == 0)
        return std::numeric_limits<double>::quiet_NaN();
    return numbers.evenness->percentile5_to_mean;
}

/// The names of all parts that were measured, in their order.
std::vector<std::string> parts_of(const Sweep& sweep) {
    std::vector<std::string> names;
    for (const SweepPoint& point : sweep.points)
        for (const PartNumbers& part : point.parts)
            if (std::ranges::find(names, part.part) == names.end()) names.push_back(part.part);
    return names;
}

std::vector<Quantity> quantities_of(const Sweep& sweep, Kind kind) {
    std::vector<Quantity> quantities;
    for (const std::string& part : parts_of(sweep))
        quantities.push_back(
            {part, [part, kind](const SweepPoint& p) { return number_of_part(p, part, kind); }});
    if (kind == Kind::evenness || sweep.points.empty() || !sweep.points.front().target)
        return quantities;
    quantities.push_back({fmt::format("target at {:g} m", sweep.points.front().target->distance),
                          [kind](const SweepPoint& p) {
                              return kind == Kind::contrast ? p.target->contrast
                                                            : p.target->signal_to_backscatter;
                          }});
    return quantities;
}

PlotCurve styled(std::string label, std::size_t index) {
    static constexpr std::array k_colours{
        plot_colour::k_blue,   plot_colour::k_red, plot_colour::k_green, plot_colour::k_orange,
        plot_colour::k_purple, plot_colour::k_sky, plot_colour::k_black};
    static constexpr std::array k_dashes{"", "8 3", "2 2.5", "9 3 2 3"};
    PlotCurve curve{std::move(label), {}, {}, k_colours[index % k_colours.size()]};
    curve.dashes = k_dashes[index / k_colours.size() % k_dashes.size()];
    curve.markers = true;
    return curve;
}

/// Logarithmic where curves lie so far apart that some would be flat.
AxisScale scale_for(const std::vector<PlotCurve>& curves) {
    double least = std::numeric_limits<double>::infinity(), greatest = 0;
    for (const PlotCurve& curve : curves)
        for (const double value : curve.y)
            if (std::isfinite(value) && value > 0) {
                least = std::min(least, value);
                greatest = std::max(greatest, value);
            }
    constexpr double k_far_apart = 20;
    return greatest > k_far_apart * least ? AxisScale::log : AxisScale::linear;
}

PlotPanel panel_of(const Sweep& sweep, const SweepArguments& a, Kind kind, const char* title,
                   const char* label) {
    PlotPanel panel{title, {sweep.keys.front(), {}}, {label, {}}, {}};
    if (kind != Kind::ratio) panel.y.request.min = 0;
    if (kind == Kind::evenness) panel.y.request.max = 1;
    std::vector<Quantity> quantities = quantities_of(sweep, kind);
    if (quantities.empty()) return panel;
    const std::size_t curves =
        a.grid.axes.size() > 1 ? a.grid.axes[1].values.size() : quantities.size();
    for (std::size_t i = 0; i < curves; ++i) {
        const bool by_value = a.grid.axes.size() > 1;
        const Quantity& quantity = by_value ? quantities.back() : quantities[i];
        PlotCurve curve =
            styled(by_value ? fmt::format("{:g}", a.grid.axes[1].values[i]) : quantity.label, i);
        for (const SweepPoint& point : sweep.points) {
            if (by_value && point.values[1] != a.grid.axes[1].values[i]) continue;
            curve.x.push_back(point.values[0]);
            curve.y.push_back(quantity.value(point));
        }
        if (!curve.x.empty()) panel.curves.push_back(std::move(curve));
    }
    if (kind == Kind::ratio) panel.y.request.scale = scale_for(panel.curves);
    if (a.grid.axes.size() > 1) panel.title += fmt::format(" ({})", quantities.back().label);
    return panel;
}

}  // namespace

std::string sweep_csv(const Sweep& sweep) {
    const bool has_target = !sweep.points.empty() && sweep.points.front().target;
    std::string text;
    for (const std::string& key : sweep.keys) text += csv_text(key) + ",";
    text += "part" + number_names_csv();
    if (has_target)
        text +=
            ",target_distance,target_contrast,target_signal,target_backscatter,"
            "target_signal_to_backscatter,target_irradiance";
    text += "\n";
    for (const SweepPoint& point : sweep.points)
        for (const PartNumbers& part : point.parts) {
            for (const double value : point.values) text += fmt::format("{},", value);
            text += csv_text(part.part) + number_values_csv(part.numbers);
            if (const auto& t = point.target)
                for (const double value : {t->distance, t->contrast, t->signal, t->backscatter,
                                           t->signal_to_backscatter, t->irradiance})
                    text += "," + number_cell(value);
            text += "\n";
        }
    return text;
}

PlotFigure sweep_figure(const Sweep& sweep, const SweepArguments& a) {
    PlotFigure figure;
    figure.title = a.scene.filename().string() + " over " + sweep.keys.front();
    for (std::size_t i = 1; i < a.grid.axes.size(); ++i)
        figure.title += ", for values of " + a.grid.axes[i].key;
    figure.panels = {
        panel_of(sweep, a, Kind::contrast, "Contrast", "Michelson contrast"),
        panel_of(sweep, a, Kind::ratio, "Signal to backscatter", "signal / backscatter"),
        panel_of(sweep, a, Kind::evenness, "Evenness of irradiance", "percentile 5 / mean")};
    figure.columns = 3;
    figure.panel_width = 400;
    std::string along;
    for (const ValueAxis& axis : a.grid.companions)
        along += fmt::format("{}{} from {:g} to {:g}", along.empty() ? "Along with it: " : ", ",
                             axis.key, axis.values.front(), axis.values.back());
    if (!along.empty()) figure.caption.push_back(along + ".");
    figure.caption.push_back(
        fmt::format("Pictures of {} x {} pixels{}. Definitions: docs/edit.md.", sweep.width,
                    sweep.height, sweep.is_complete ? "" : "; interrupted, not all of them"));
    return figure;
}

std::string best_of(const Sweep& sweep) {
    const std::vector<Quantity> quantities = quantities_of(sweep, Kind::contrast);
    if (quantities.empty()) return {};
    const Quantity& quantity = quantities.back();
    const SweepPoint* best = nullptr;
    for (const SweepPoint& point : sweep.points)
        if (!std::isnan(quantity.value(point)) &&
            (best == nullptr || quantity.value(point) > quantity.value(*best)))
            best = &point;
    if (best == nullptr) return {};
    std::string text =
        fmt::format("best contrast of {}: {:.3g} at", quantity.label, quantity.value(*best));
    for (std::size_t i = 0; i < sweep.keys.size(); ++i)
        text += fmt::format(" {}={:g}", sweep.keys[i], best->values[i]);
    return text;
}

namespace {

std::filesystem::path table_of(const SweepArguments& a) {
    if (a.output.empty()) return a.scene.stem().string() + "-sweep.csv";
    if (a.output.extension() != ".csv")
        throw UsageError(fmt::format("-o {}: it is written as CSV; give a name that ends in .csv",
                                     printable(a.output.string(), 300)));
    return a.output;
}

}  // namespace

void run_sweep(const SweepArguments& a) {
    check_axes(a);
    const ThreadLimit limit(a.threads);
    const std::filesystem::path table = table_of(a);
    std::filesystem::path plot = table;
    plot.replace_extension(".svg");
    scene_at(a, 0);  // whose files outputs never replace
    check_outputs({table, plot});
    begin_orderly_stop();
    Sweep sweep;
    {
        const StopScope scope(stop_flag());
        Progress progress("sweep", "pictures", static_cast<double>(a.grid.count()), a.progress);
        sweep = run_pictures(a, [&](double fraction) { progress.update(fraction); });
    }
    for (const std::string& warning : sweep.warnings)
        print_message(fmt::format("warning: {}\n", warning));
    if (sweep.points.empty()) throw Interrupted();
    TextFiles files;
    files.add(table, sweep_csv(sweep));
    files.add(plot, svg_document(sweep_figure(sweep, a)));
    if (!a.quiet) print_message(best_of(sweep) + "\n");
    files.commit(a.quiet);
    if (!sweep.is_complete)
        throw Interrupted(fmt::format("interrupted; {} of {} pictures are measured",
                                      sweep.points.size(), a.grid.count()));
}

Command sweep_command() {
    const auto arguments = std::make_shared<SweepArguments>();
    return {"sweep", "measure a scene over a range of values: a table and a plot", k_sweep_examples,
            sweep_options(*arguments), [arguments] {
                install_stop_signal();
                run_sweep(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
