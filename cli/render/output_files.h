#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cli/render/render_arguments.h"
#include "core/scene/sensor_desc.h"
#include "render/input_files.h"

namespace uw {

/// The files that one render writes.
struct OutputFiles {
    std::filesystem::path image;            // EXR; empty: the PNG alone
    std::filesystem::path preview;          // PNG beside it
    std::filesystem::path sensor{};         // the camera's image, PNG or JPEG; empty: none
    std::filesystem::path stats;            // JSON; empty: none
    std::filesystem::path irradiance_vdb;   // empty: none
    std::filesystem::path numbers{};        // CSV about all images; empty: none
    std::filesystem::path ids{};            // CSV of names; empty: no layer of numbers
    std::filesystem::path contact_sheet{};  // PNG of all images; empty: none
    std::filesystem::path manifest_csv{}, manifest_json{};  // of all variations; empty: none

    /// The EXR, or the preview or the camera's image where that is all.
    const std::filesystem::path& main() const {
        return !image.empty() ? image : preview.empty() ? sensor : preview;
    }
    /// What is to be looked at: the preview, or the camera's image where that is all.
    const std::filesystem::path& picture() const { return preview.empty() ? sensor : preview; }
};

/// What the names of cameras' images have before their ending.
inline constexpr std::string_view k_sensor_ending = ".sensor";

/// The camera's image beside others: "out.sensor.png" beside "out.exr".
std::filesystem::path sensor_image_beside(const std::filesystem::path& image,
                                          DevelopmentDesc::Format format);

/// The files that the arguments request; names keep their placeholders for the frame number, and so
/// does the default name of a sequence's images. Throws UsageError for a name whose ending is not
/// that of its format.
OutputFiles output_files(const RenderArguments& arguments);

/// Checks before the work, rather than after it, that all files can be written.
class OutputCheck {
  public:
    /// Registers files that are read.
    void take_inputs(const std::vector<InputFile>& inputs);
    /// Removes what killed runs left where they are to be, too. Throws UsageError if two files are
    /// the same, or one has been registered before; IoError if one cannot be created.
    void take_outputs(const OutputFiles& files);

  private:
    std::map<std::filesystem::path, std::string> taken_;
    std::set<std::filesystem::path> tidied_;  // folders
};

}  // namespace uw
