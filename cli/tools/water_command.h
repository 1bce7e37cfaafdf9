#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"

namespace uw {

/// Reads the wavelengths [nm] of --bands: a list "620,540,450" or a range "first:last:step" that
/// ends at or before `last`; 1 to 2000 of them, each once. Throws UsageError of one line.
std::vector<double> parse_bands(const std::string& text);

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

/// The options of `uwvdb water`, written to `arguments`.
Options water_options(WaterArguments& arguments);

/// `uwvdb water`: tables of a, b, c and beta of a preset's or a scene's water on `out`, as text or
/// JSON, and in the requested CSV and SVG files. Warnings and names of files written go to stderr.
/// Throws UsageError, InputError and IoError; then no file has been touched, unless it is `out`
/// that cannot be written.
void run_water(const WaterArguments& arguments, std::ostream& out);

/// `uwvdb water` as the command line knows it.
Command water_command();

}  // namespace uw
