#include "core/image/image_quantity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {

double focus_factor(double distance, double focal_length) {
    const double ratio = 1 - focal_length / distance;
    return ratio > 0 ? ratio * ratio : 0.0;
}

SensorModel::SensorModel(const SceneDesc& desc)
    : SensorModel(desc.render.output, desc.camera.lens) {}

SensorModel::SensorModel(RenderDesc::Output output, const std::optional<LensDesc>& lens)
    : output_(output) {
    if (output_ != RenderDesc::Output::radiance) lens_ = lens.value();
}

double SensorModel::pixel_factor(const LensRay& lens_ray, double range) const {
    if (output_ == RenderDesc::Output::radiance) return lens_ray.port_transmittance;
    const double lens = std::numbers::pi / 4 * lens_.transmission * lens_ray.falloff;
    const double through_port = lens_ray.port_transmittance * lens;
    if (output_ == RenderDesc::Output::paper) return through_port / lens_.f_number;
    return through_port / (lens_.f_number * lens_.f_number) *
           focus_factor(range, lens_.focal_length);
}

double SensorModel::surface_factor(double path) const {
    return output_ == RenderDesc::Output::paper ? focus_factor(path, lens_.focal_length) : 1.0;
}

double SensorModel::mean_surface_factor(double begin, double end) const {
    if (output_ != RenderDesc::Output::paper) return 1;
    const double focal = lens_.focal_length;
    const double from = std::max(begin, focal);
    if (from >= end) return 0;
    // int (1 - F/s)^2 ds = s - 2 F ln s - F^2 / s
    const double integral =
        (end - from) - 2 * focal * std::log(end / from) - focal * focal * (1 / end - 1 / from);
    return std::max(0.0, integral) / (end - begin);
}

std::string SensorModel::description() const {
    switch (output_) {
        case RenderDesc::Output::radiance:
            break;
        case RenderDesc::Output::sensor_irradiance:
            return "sensor irradiance W m^-2";
        case RenderDesc::Output::paper:
            return "sensor irradiance as in Sedlazeck and Koch 2011, 4 N for 4 N^2, W m^-2";
    }
    return "radiance W m^-2 sr^-1";
}

}  // namespace uw
