#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"

namespace uw {

/// `uwvdb project` and `uwvdb rays` as typed.
struct PointsArguments {
    std::filesystem::path scene;
    std::filesystem::path table;             // the CSV that is read
    std::filesystem::path output;            // -o; empty: standard output
    std::string camera;                      // --camera: of a rig
    std::optional<int> frame;                // --frame: of meshes that are sequences
    std::optional<std::array<int, 2>> size;  // --size WxH
    std::vector<std::string> overrides;      // --set key.path=value
    int threads = 0;                         // 0: all
    bool quiet = false;
};

/// What `uwvdb project --help` and `uwvdb rays --help` end with.
extern const char* const k_project_examples;
extern const char* const k_rays_examples;

/// Their options, written to `arguments`; `table_name` is that of the CSV in help.
Options points_options(PointsArguments& arguments, std::string table_name, std::string table_help);

}  // namespace uw
