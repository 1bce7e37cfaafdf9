#pragma once

#include <filesystem>
#include <optional>

#include "cli/render/frame_sequence.h"
#include "core/files/output_file.h"
#include "core/image/digital_image.h"
#include "core/image/film.h"
#include "core/image/image_metadata.h"
#include "core/sensor/development.h"
#include "render/renderer.h"

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

}  // namespace uw
