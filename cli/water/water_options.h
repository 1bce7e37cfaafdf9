#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"

namespace uw {

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

/// What `uwvdb water --help` ends with.
extern const char* const k_water_examples;

/// The options of `uwvdb water`, written to `arguments`.
Options water_options(WaterArguments& arguments);

}  // namespace uw
