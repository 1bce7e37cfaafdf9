#include "cli/tools/record_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "dataset/sensor_files.h"
#include "render/navigation/vehicle_motion.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

const char* const k_record_examples = R"(Examples:
  uwvdb record dive.yaml -o dive                 readings of all sensors, and the trajectory
  uwvdb record dive.yaml -o dive --rate 1000     the trajectory with 1000 poses a second
  uwvdb record rest.yaml -o rest --to 3600       an hour of a vehicle that stands still

Writes what the scene's vehicle records along its trajectory, without rendering anything: NAME.csv of
each of the `sensors` (imu, pressure, dvl, altimeter, magnetometer), readings and truth; NAME.yaml of
an IMU, for Kalibr; trajectory.tum and trajectory.csv, poses and velocities of the rig or camera;
sensors.json, where sensors and cameras are on it. Stamps are those of `uwvdb dataset`.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.
More: docs/datasets.md)";

struct RecordArguments {
    std::filesystem::path scene, output;
    std::vector<std::string> overrides;
    std::optional<double> from, to, rate;
    int threads = 0;
    bool quiet = false;
};

constexpr double k_longest_record = 1e9;  // [s]

Options record_options(RecordArguments& a) {
    Options options;
    options.input("SCENE", "", a.scene, "scene file (docs/scene-file.md)").required = true;
    options.output("-o,--output", "FOLDER", a.output,
                   "the folder of the files; default: the scene's name with -sensors");
    options.number("--from", "T", a.from, -k_longest_record, k_longest_record,
                   "the first time in seconds; default: that of the first pose, or 0");
    options.number("--to", "T", a.to, -k_longest_record, k_longest_record,
                   "the last time in seconds; default: that of the last pose");
    options.number(
        "--rate", "HZ", a.rate, 0, 10'000,
        "poses of the trajectory a second; default: as the fastest sensor, or render.fps");
    options.set(a.overrides);
    options.threads(a.threads);
    options.confine();
    options.flag("--quiet", a.quiet, "print nothing but warnings and errors");
    return options;
}

/// The times that are asked for.
TimeRange span_of(const RecordArguments& a, const VehicleMotion& vehicle) {
    const auto times = vehicle.times();
    if (!times && !a.to)
        throw UsageError(
            "--to: the vehicle has no trajectory whose end is the end; give the last time in "
            "seconds");
    const TimeRange span{a.from.value_or(times ? times->first : 0), a.to ? *a.to : times->last};
    if (!(span.first <= span.last))
        throw UsageError(
            fmt::format("--to: {:g} s is before the first time, {:g} s; give a later "
                        "one",
                        span.last, span.first));
    if (times && (span.first < times->first - 1e-6 || span.last > times->last + 1e-6))
        throw UsageError(fmt::format(
            "{}: the trajectory has poses from {:g} to {:g} s; give times within",
            span.first < times->first - 1e-6 ? "--from" : "--to", times->first, times->last));
    return span;
}

void run_record(const RecordArguments& a) {
    const SceneDesc scene = load_scene(a.scene, a.overrides);
    const std::filesystem::path folder =
        a.output.empty() ? std::filesystem::path(a.scene.stem().string() + "-sensors") : a.output;
    for (const std::string& warning : scene.warnings)
        print_message(fmt::format("warning: {}\n", warning));
    const VehicleMotion vehicle(scene);
    const TimeRange span = span_of(a, vehicle);
    check_outputs({folder / "sensors.json"});
    std::vector<NamedText> texts;
    with_threads(a.threads, [&] { texts = sensor_files(scene, span, a.rate.value_or(0)); });
    if (!vehicle.is_smooth() && !a.quiet)
        print_message(
            "note: the trajectory goes straight from pose to pose, so that there are no "
            "velocities: trajectory.tum alone is written\n");
    TextFiles files;
    for (const NamedText& text : texts) files.add(folder / text.name, text.text);
    files.commit(a.quiet);
}

}  // namespace

Command record_command() {
    const auto arguments = std::make_shared<RecordArguments>();
    return {"record", "write what a vehicle's sensors record along its trajectory",
            k_record_examples, record_options(*arguments), [arguments] {
                run_record(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
