#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "camera/calibration.h"
#include "cli/command.h"

namespace uw {

/// `uwvdb calibration` as typed.
struct CalibrationArguments {
    std::filesystem::path file;               // a calibration, or a scene
    std::string camera;                       // --camera: which of several
    std::optional<CalibrationFormat> format;  // --to
    std::filesystem::path output;             // -o; empty: standard output
    bool json = false;
};

/// What `uwvdb calibration --help` ends with.
extern const char* const k_calibration_examples;

/// The options of `uwvdb calibration`, written to `arguments`.
Options calibration_options(CalibrationArguments& arguments);

/// Angles between the outermost rays of the image through its principal point [rad]; narrower than
/// the image where the lens or the port has no rays for part of it.
struct FieldOfView {
    double horizontal = 0, vertical = 0, diagonal = 0;
};

/// What `uwvdb calibration` reports.
struct CalibrationReport {
    std::filesystem::path file;
    Calibration calibration;
    FieldOfView in_lens;                  // in the housing; in the water without a port
    std::optional<FieldOfView> in_water;  // behind a port
    /// Angle to the axis up to which the lens has rays [rad], and its distance from the principal
    /// point along x [pixels]; empty for a lens that covers everything before it.
    std::optional<double> fold_angle, fold_radius;
    double covered = 0;  // fraction of the image's pixels with a ray into the water
    struct Target {
        CalibrationFormat format;
        std::string obstacle;  // empty: it can be written
    };
    std::vector<Target> targets;
};

CalibrationReport report_on(const std::filesystem::path& file, const Calibration& calibration);

/// For people, ASCII.
std::string calibration_text(const CalibrationReport& report);

/// A report as one JSON object (docs/command-line.md).
std::string calibration_json(const CalibrationReport& report);

/// `uwvdb calibration`: what was understood of a calibration file, or of a scene's camera, as text
/// or JSON on `out`; with a format to write, that file's text instead, into a file or on `out`.
/// Warnings and names of files written go to stderr. Throws UsageError, InputError and IoError;
/// then no file has been touched, unless it is `out` that cannot be written.
void run_calibration(const CalibrationArguments& arguments, std::ostream& out);

/// `uwvdb calibration` as the command line knows it.
Command calibration_command();

}  // namespace uw
