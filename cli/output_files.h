#pragma once

#include <filesystem>

#include "cli/arguments.h"
#include "core/scene_desc.h"

namespace uw {

/// The files that one render writes.
struct OutputFiles {
    std::filesystem::path image;           // EXR
    std::filesystem::path preview;         // PNG beside it
    std::filesystem::path stats;           // JSON; empty: none
    std::filesystem::path irradiance_vdb;  // empty: none
};

/// What the arguments ask for. Throws UsageError for a name whose ending is not that of its format.
OutputFiles output_files(const RenderArguments& arguments);

/// Finds out before the work rather than after it whether all can be written. Throws UsageError if
/// two are one file, or one is a file that the scene is read from; IoError if one cannot be made.
void check_output_files(const OutputFiles& files, const SceneDesc& scene);

}  // namespace uw
