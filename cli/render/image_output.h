#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/render/frame_sequence.h"
#include "core/base/error.h"
#include "core/base/output_files.h"
#include "core/image/development.h"
#include "core/image/film.h"
#include "core/image/image_file.h"
#include "core/image/pixel_image.h"
#include "core/passes/render_film.h"
#include "render/renderer.h"
#include "render/scene_assembly.h"

namespace uw {

/// What a camera stores of an image, and how.
struct SensorImage {
    DigitalImage image;
    DevelopmentDesc desc;
};

/// Writes all of a PNG or JPEG of it. Throws IoError and Interrupted; what cannot be written is for
/// out.commit() to report.
void write_sensor_image(OutputFile& out, const SensorImage& sensor, const ImageMetadata& metadata);

/// Makes the camera's image of a frame, if it is to have one, of what is rendered for it.
class SensorImager {
  public:
    /// `wanted` of the frame otherwise, with a window. Throws as Development.
    SensorImager(const Frame& frame, const SceneDesc& scene, const RenderOptions& wanted);

    /// What to render: `wanted`, and what the camera's image needs.
    const RenderOptions& rendered() const { return rendered_; }

    /// The camera's image of the film rendered, which then becomes the one wanted: `plan` has its
    /// layers.
    std::optional<SensorImage> take(Film& film, const LayerPlan& plan) const;

  private:
    std::optional<Development> development_;
    DevelopmentDesc desc_;
    PixelWindow window_;  // wanted
    RenderOptions rendered_;
};

/// Prints one line.
using SayCallback = std::function<void(const std::string& line)>;

/// How images are written.
struct ImageStorage {
    ExrOptions exr{};
    std::optional<double> exposure{};  // of the preview; none: its automatic one
    bool is_preview_16_bit = false;
};

/// Writes the EXR, if it has a name, likewise its preview, the camera's image if there is one, and
/// the table of its ids if there is to be one: with what is in `outputs` already all of them whole,
/// or none. Prints where they are and the exposure of the preview, and warns of an image that is
/// black or empty in part, or that half floats cannot hold. Throws IoError and Interrupted.
void write_images(const OutputFiles& files, const Film& film,
                  const std::optional<SensorImage>& sensor, const SurfaceNames& names,
                  ImageMetadata metadata, const ImageStorage& storage, OutputGroup& outputs,
                  const SayCallback& say, const SayCallback& warn);

}  // namespace uw
