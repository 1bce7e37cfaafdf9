#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/render/render_arguments.h"
#include "render/input_files.h"

namespace uw {

/// The files that one render writes.
struct OutputFiles {
    std::filesystem::path image;           // EXR
    std::filesystem::path preview;         // PNG beside it
    std::filesystem::path stats;           // JSON; empty: none
    std::filesystem::path irradiance_vdb;  // empty: none
};

/// What the arguments ask for; names hold places for the frame's number where they do there, and
/// so does the image's default name for a sequence. Throws UsageError for a name whose ending is
/// not that of its format.
OutputFiles output_files(const RenderArguments& arguments);

/// Finds out before the work rather than after it whether all can be written.
class OutputCheck {
  public:
    /// Takes note of files that are read.
    void take_inputs(const std::vector<InputFile>& inputs);
    /// Throws UsageError if two files are one, or one is a file that has been taken note of;
    /// IoError if one cannot be made.
    void take_outputs(const OutputFiles& files);

  private:
    std::map<std::filesystem::path, std::string> taken_;
};

}  // namespace uw
