#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cli/render/frame_sequence.h"
#include "core/base/output_files.h"
#include "core/image/colour_view.h"
#include "core/image/exr_file.h"
#include "core/scene/sensor_desc.h"
#include "render/run/run_engine.h"

namespace uw {

/// Prints one line.
using SayCallback = std::function<void(const std::string& line)>;

/// How images are written.
struct ImageStorage {
    ExrOptions exr{};
    std::optional<double> exposure{};          // of the preview; none: its automatic one
    std::optional<int> preview_bits{};         // none: as is usual in its format
    std::shared_ptr<const ColourView> view{};  // of the preview; null: sRGB
    DevelopmentDesc camera{};                  // of the camera's image, if there is one
};

/// Writes the image, if it has a name, likewise its preview, the camera's image if there is one,
/// and the table of its ids if there is to be one: with what is in `outputs` already all of them
/// whole, or none. Prints where they are and the exposure of the preview, and warns of an image
/// that is black or empty in part, or beyond the range of half floats. Throws IoError and
/// Interrupted.
void write_images(const OutputFiles& files, const FinishedImage& image, const ImageStorage& storage,
                  OutputGroup& outputs, const SayCallback& say, const SayCallback& warn);

}  // namespace uw
