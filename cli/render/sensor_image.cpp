#include "cli/render/sensor_image.h"

#include <algorithm>

#include "core/image/jpeg_writer.h"
#include "core/image/png_writer.h"

namespace uw {

namespace {

// The window with as many more pixels of the image around it.
PixelWindow grown(const PixelWindow& window, int margin, const CameraDesc& camera) {
    return {std::max(window.x0 - margin, 0), std::max(window.y0 - margin, 0),
            std::min(window.x1 + margin, camera.width),
            std::min(window.y1 + margin, camera.height)};
}

}  // namespace

void write_sensor_image(OutputFile& out, const SensorImage& sensor, const ImageMetadata& metadata) {
    if (sensor.desc.format == DevelopmentDesc::Format::jpeg)
        write_jpeg_file(out, sensor.image, sensor.desc.quality, metadata);
    else
        write_png_file(out, sensor.image, metadata);
}

SensorImager::SensorImager(const Frame& frame, const SceneDesc& scene, const RenderOptions& wanted)
    : window_(wanted.window.value()), rendered_(wanted) {
    if (frame.files.sensor.empty()) return;
    const SensorDesc& sensor = scene.camera.sensor.value();
    development_.emplace(sensor);
    desc_ = sensor.image;
    rendered_.layers = (wanted.layers.empty() ? "default" : wanted.layers) + ",sensor";
    rendered_.window = grown(window_, development_->margin(), scene.camera);
    rendered_.frame = frame.number.value_or(0);
}

std::optional<SensorImage> SensorImager::take(Film& film, const LayerPlan& plan) const {
    if (!development_) return std::nullopt;
    SensorImage image{(*development_)(film, window_), desc_};
    if (film.window() != window_ || film.channel_names() != plan.channel_names())
        film = with_channels(film, plan.channel_names(), window_);
    return image;
}

}  // namespace uw
