#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"

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

/// `uwvdb info`: what a VDB file or a scene holds, in metres, and what to fix, as text or JSON for
/// stdout. Throws UsageError, InputError and IoError of one line each.
std::string run_info(const InfoArguments& arguments);

/// `uwvdb info` as the command line knows it.
Command info_command();

}  // namespace uw
