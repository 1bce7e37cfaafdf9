#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/sweep/sweep_options.h"
#include "render/measures/lamp_numbers.h"
#include "render/measures/target_probe.h"

namespace uw {

/// What was measured with one choice of the values that are varied.
struct SweepPoint {
    std::vector<double> values;      // of the axes, then of the first one's companions
    std::vector<PartNumbers> parts;  // of all light; an object out of the picture has none
    std::optional<TargetNumbers> target;
};

/// What was measured, in the order of the grid: the second axis is the slower one.
struct Sweep {
    std::vector<std::string> keys;  // of SweepPoint::values
    std::vector<SweepPoint> points;
    std::vector<std::string> warnings;  // about its pictures, each once
    int width = 0, height = 0;          // of its pictures [pixels]
    bool is_complete = false;
};

/// Called with the share of the pictures that is done; false ends the sweep with what there is.
using SweepProgress = std::function<bool(double share)>;

/// Reads the scene with all choices, and only if all of them can be read renders and measures one
/// after the other. Throws UsageError, InputError and IoError.
Sweep run_pictures(const SweepArguments& arguments, const SweepProgress& progress);

}  // namespace uw
