#include "core/sensor/camera_sensor.h"

#include "core/base/parallel.h"

namespace uw {
namespace {

// The light of a pixel per band; with three bands these are R G B.
std::span<const float> light_of(const LayerPlan& plan, std::span<float> pixel) {
    if (plan.has(Layer::total)) return plan.channels(Layer::total, pixel);
    return pixel.first(3);
}

}  // namespace

CameraSensor::CameraSensor(const SceneDesc& scene, std::int64_t frame)
    : mosaic_(scene.camera.sensor->mosaic),
      photoelectrons_(scene),
      readout_(*scene.camera.sensor, {scene.camera_name, frame}) {}

void CameraSensor::expose(const RaySource& rays, const LayerPlan& plan, Film& film) const {
    const PixelWindow& window = film.window();
    const double vergence = rays.focus_vergence();
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        const int y = window.y0 + static_cast<int>(line);
        for (int x = window.x0; x < window.x1; ++x) {
            const std::span<float> pixel = film.pixel(x, y);
            Spectrum irradiance;
            if (pixel[k_alpha] > 0) {
                const double factor =
                    photoelectrons_.irradiance_factor(rays.lens_ray(x + 0.5, y + 0.5), vergence);
                std::size_t b = 0;
                for (const float radiance : light_of(plan, pixel))
                    irradiance[b++] = factor * static_cast<double>(radiance);
            }
            std::size_t colour = colour_at(mosaic_, x, y);
            for (float& number : plan.channels(Layer::sensor, pixel)) {
                const double electrons = photoelectrons_.mean(irradiance, colour);
                number = static_cast<float>(readout_.number(electrons, x, y, colour++));
            }
        }
    });
}

}  // namespace uw
