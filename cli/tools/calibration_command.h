#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "camera/calibration.h"
#include "camera/lateral_colour.h"
#include "cli/command.h"
#include "cli/report.h"

namespace uw {

/// Angles between the outermost rays of the image through its principal point [rad]; narrower than
/// the image where the lens or the port has no rays for part of it.
struct FieldOfView {
    double horizontal = 0, vertical = 0, diagonal = 0;
};

/// What `uwvdb calibration` reports.
struct CalibrationSurvey {
    std::filesystem::path file;
    Calibration calibration;
    FieldOfView in_lens;                  // in the housing; in the water without a port
    std::optional<FieldOfView> in_water;  // behind a port
    /// Angle to the axis up to which the lens has rays [rad], and its distance from the principal
    /// point along x [pixels]; empty for a lens that covers everything before it.
    std::optional<double> fold_angle, fold_radius;
    /// The greatest shifts of the bands of a scene relative to light of the camera's wavelength
    /// [pixels]; empty if the port's indices do not depend on the wavelength.
    std::vector<BandShift> lateral_colour;
    double covered = 0;  // fraction of the image's pixels with a ray into the water
    struct Target {
        CalibrationFormat format;
        std::string obstacle;  // empty: it can be written
    };
    std::vector<Target> targets;
};

/// `bands_nm`: those of a scene.
CalibrationSurvey survey_calibration(const std::filesystem::path& file,
                                     const Calibration& calibration,
                                     std::span<const double> bands_nm = {});

/// The report as text for people (ASCII) or as JSON for programs (docs/command-line.md).
Report report_on_calibration(const CalibrationSurvey& survey);

/// Whether a file declares itself a scene: some line begins with "uwvdb:". A file that cannot be
/// read is left to the reader.
bool is_scene(const std::filesystem::path& file);

/// `uwvdb calibration` as the command line knows it.
Command calibration_command();

}  // namespace uw
