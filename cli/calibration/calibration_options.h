#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "camera/calibration/calibration.h"
#include "cli/options.h"

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

}  // namespace uw
