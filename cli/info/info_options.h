#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"

namespace uw {

/// `uwvdb info` as typed.
struct InfoArguments {
    std::filesystem::path subject;       // a VDB file, a sequence of them, or a scene
    std::vector<std::string> overrides;  // --set key.path=value, of a scene
    std::optional<int> frame;            // --frame, of a sequence; else the first that exists
    bool json = false;
    bool scene = false;             // --scene: print a whole scene instead, of a VDB file
    std::filesystem::path picture;  // --picture: a thumbnail of that scene; empty: none
    std::filesystem::path svg;      // --svg: the camera's path over a scene; empty: none
};

/// What `uwvdb info --help` ends with.
extern const char* const k_info_examples;

/// The options of `uwvdb info`, written to `arguments`.
Options info_options(InfoArguments& arguments);

}  // namespace uw
