#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/pages/svg_plot.h"
#include "cli/render/picture_numbers.h"
#include "core/base/progress.h"
#include "render/measures/picture_numbers.h"
#include "render/meters/target_probe.h"
#include "render/run/job.h"

namespace uw {

/// The axis that an override describes; none if its value is not such a range. Both ends are
/// included, up to rounding; the step's sign does not matter. Throws UsageError for an invalid
/// range, or one of more than 1000 values.
std::optional<ValueAxis> sweep_axis(const std::string& override);

/// `uwvdb sweep` as typed.
struct SweepArguments {
    std::filesystem::path scene;
    std::filesystem::path output;        // the CSV; empty: the scene's name with -sweep.csv
    std::vector<std::string> overrides;  // --set key.path=value
    ValueGrid grid;  // --set key.path=first:last:step, one or two axes; --with: companions
    std::optional<double> target;            // --target: distance of a target [m]
    PartArguments parts;                     // --part, --object
    std::string camera;                      // --camera: of a rig
    std::optional<int> frame;                // --frame: of sequences
    std::optional<std::array<int, 2>> size;  // --size WxH; none: at most 480 pixels wide
    std::string quality = "draft";           // --quality
    int threads = 0;
    bool quiet = false;
    ProgressForm progress = ProgressForm::text;
};

/// What `uwvdb sweep --help` ends with.
extern const char* const k_sweep_examples;

/// The options of `uwvdb sweep`, written to `arguments`.
Options sweep_options(SweepArguments& arguments);

/// Throws UsageError unless there are one or two axes, and companions are as long as the first.
void check_axes(const SweepArguments& arguments);

/// What was measured with one choice of the values that are varied.
struct SweepPoint {
    std::vector<double> values;      // of Sweep::keys
    std::vector<PartNumbers> parts;  // of all light; an object out of the picture has none
    std::optional<TargetNumbers> target;
};

/// What was measured, in the order of the grid: the second axis is the slower one.
struct Sweep {
    std::vector<std::string> keys;  // as ValueGrid::keys
    std::vector<SweepPoint> points;
    std::vector<std::string> warnings;  // about its pictures, each once
    int width = 0, height = 0;          // of its pictures [pixels]
    bool is_complete = false;
};

/// Reads the scene with all choices, and only if all of them can be read renders and measures one
/// after the other; a sweep that is stopped has those measured until then. `progress` receives the
/// share of the pictures that is done. Throws UsageError, InputError and IoError.
Sweep run_pictures(const SweepArguments& arguments, const ProgressCallback& progress);

/// A row for each picture and part of it: the values that were varied, then what was measured.
std::string sweep_csv(const Sweep& sweep);

/// Contrast, signal to backscatter and evenness over the first axis; a curve for each part, or for
/// each value of a second axis.
PlotFigure sweep_figure(const Sweep& sweep, const SweepArguments& arguments);

/// Where the contrast is best, one line without a line break: of the target, else of the last part.
std::string best_of(const Sweep& sweep);

/// `uwvdb sweep`: renders a scene for a grid of values, measures the pictures, and writes a table
/// and a plot of them; reports on stderr. What was measured before Ctrl-C is written, too; then it
/// throws Interrupted. Throws UsageError, InputError and IoError; then no file has been touched.
void run_sweep(const SweepArguments& arguments);

/// `uwvdb sweep` as the command line knows it.
Command sweep_command();

}  // namespace uw
