#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/numbers/picture_parts.h"
#include "cli/options.h"
#include "cli/sweep/sweep_axis.h"

namespace uw {

/// `uwvdb sweep` as typed.
struct SweepArguments {
    std::filesystem::path scene;
    std::filesystem::path output;            // the CSV; empty: the scene's name with -sweep.csv
    std::vector<std::string> overrides;      // --set key.path=value
    std::vector<SweepAxis> axes;             // --set key.path=first:last:step, one or two
    std::vector<SweepAxis> companions;       // --with: vary along with the first axis
    std::optional<double> target;            // --target: distance of a target [m]
    PartArguments parts;                     // --part, --object
    std::string camera;                      // --camera: of a rig
    std::optional<int> frame;                // --frame: of sequences
    std::optional<std::array<int, 2>> size;  // --size WxH; none: at most 480 pixels wide
    RenderDesc::Quality quality = RenderDesc::Quality::draft;  // --quality
    int threads = 0;
    bool quiet = false;

    /// The number of pictures.
    std::size_t count() const;
};

/// What `uwvdb sweep --help` ends with.
extern const char* const k_sweep_examples;

/// The options of `uwvdb sweep`, written to `arguments`.
Options sweep_options(SweepArguments& arguments);

/// Throws UsageError unless there are one or two axes, and companions are as long as the first.
void check_axes(const SweepArguments& arguments);

}  // namespace uw
