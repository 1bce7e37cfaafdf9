#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "camera/calibration/calibration.h"

namespace uw {

/// `uwvdb render` as typed.
struct RenderArguments {
    std::filesystem::path scene;
    std::filesystem::path output;            // empty: the scene's name with .exr, here
    std::vector<int> frames;                 // --frames; empty: no sequence
    bool resume = false;                     // --resume
    std::vector<std::string> overrides;      // --set key.path=value
    std::optional<std::array<int, 2>> size;  // --size WxH
    std::optional<std::array<int, 4>> crop;  // --crop x0,y0,x1,y1
    std::string camera;                      // --camera: of a rig this one only; empty: all
    std::string integrator;                  // empty: the scene's
    std::string layers;                      // empty: the default set
    std::optional<int> samples;
    std::string quality;  // draft or final; empty: final
    int threads = 0;      // 0: all
    std::filesystem::path stats;
    std::filesystem::path irradiance_vdb;
    bool quiet = false;
};

/// `uwvdb water` as typed.
struct WaterArguments {
    std::string subject;                 // a preset or a scene file; empty: pure sea water
    std::vector<std::string> overrides;  // --set key.path=value
    std::vector<double> bands_nm;        // --bands; empty: the water's own
    std::optional<double> band_nm;       // --band: the VSF at this one only
    std::filesystem::path csv;           // --csv: beginning of the names of two files
    std::filesystem::path svg;
    bool json = false;
};

/// `uwvdb info` as typed.
struct InfoArguments {
    std::filesystem::path subject;       // a VDB file, a sequence of them, or a scene
    std::vector<std::string> overrides;  // --set key.path=value, of a scene
    std::optional<int> frame;            // --frame, of a sequence; else the first there is
    bool json = false;
};

/// `uwvdb validate` as typed.
struct ValidateArguments {
    std::filesystem::path scene;         // empty: the built-in suite
    std::vector<std::string> overrides;  // --set key.path=value
    std::filesystem::path report;        // --report: HTML
    double tolerance = 1e-3;
    int threads = 0;  // 0: all
    bool quiet = false;
};

/// `uwvdb calibration` as typed.
struct CalibrationArguments {
    std::filesystem::path file;               // a calibration, or a scene
    std::string camera;                       // --camera: which of several
    std::optional<CalibrationFormat> format;  // --to
    std::filesystem::path output;             // -o; empty: standard output
    bool json = false;
};

/// Help or version text to print instead of doing anything.
struct MessageArguments {
    std::string text;
};

/// What the command line asks for.
using Arguments = std::variant<MessageArguments, RenderArguments, InfoArguments, WaterArguments,
                               ValidateArguments, CalibrationArguments>;

/// Parses the command line. Throws UsageError with one line for a wrong one.
Arguments parse_arguments(int argc, const char* const* argv);

}  // namespace uw
