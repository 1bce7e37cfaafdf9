#include "cli/info/draft_contrast.h"

#include <algorithm>
#include <cmath>

#include "camera/image_size.h"
#include "core/base/parallel.h"
#include "core/colour/colour.h"
#include "core/optics/optical_depth.h"
#include "render/measures/pixel_values.h"

namespace uw {

namespace {

/// Per pixel, row by row; 0 where no ray enters the water.
std::vector<double> luminances(const Film& film) {
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(film.width()) *
                   static_cast<std::size_t>(film.height()));
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const std::span<const float> pixel = film.pixel(x, y);
            const double light = luminance({pixel[k_red], pixel[k_green], pixel[k_blue]});
            values.push_back(pixel[k_alpha] > 0 && std::isfinite(light) ? std::max(light, 0.0) : 0);
        }
    return values;
}

/// Optical depth of the volumes along the rays of all pixels up to the first surface.
std::vector<double> volume_depths(const AssembledScene& scene) {
    const int width = scene.desc.camera.width, height = scene.desc.camera.height;
    std::vector<double> depths(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const Bounds bounds = scene.field->bounds();
    if (bounds.empty()) return depths;
    const Medium& medium = scene.water.medium;
    const AttenuationTable attenuation(medium);
    const auto band = static_cast<std::size_t>(medium.band_count() / 2);
    parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
        std::vector<double> columns(static_cast<std::size_t>(medium.constituent_count()));
        for (int x = 0; x < width; ++x) {
            const auto ray = scene.camera->refracted_ray(x + 0.5, static_cast<double>(row) + 0.5);
            if (!ray) continue;
            const double end = std::min(scene.surfaces->hit_distance(*ray),
                                        distance(ray->origin, bounds.center()) + bounds.diagonal());
            scene.field->column(ray->origin, ray->at(end), columns);
            depths[row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
                attenuation.optical_depth(band, 0, columns);
        }
    });
    return depths;
}

}  // namespace

DraftContrast compare_drafts(const AssembledScene& scene, const Film& with, const Film& without) {
    std::vector<double> light = luminances(with);
    const std::vector<double> before = luminances(without);
    const std::vector<double> depths = volume_depths(scene);
    double mean = 0;
    for (const double value : before) mean += value / static_cast<double>(before.size());
    std::vector<double> contrasts, brightness, depth;
    for (std::size_t n = 0; n < depths.size(); ++n) {
        if (!(depths[n] > 0)) continue;
        const double reference = std::max(before[n], mean);
        contrasts.push_back(reference > 0 ? std::abs(light[n] - before[n]) / reference : 0);
        brightness.push_back(light[n]);
        depth.push_back(depths[n]);
    }
    DraftContrast result;
    result.seen = static_cast<double>(contrasts.size()) / static_cast<double>(depths.size());
    if (contrasts.empty()) return result;
    result.contrast = percentile(contrasts, 0.99);
    const double bright = percentile(light, 0.99);
    if (bright > 0) result.brightness = percentile(brightness, 0.5) / bright;
    result.depth = percentile(depth, 0.9);
    return result;
}

void make_draft(SceneDesc& desc, int width) {
    desc.render.quality = RenderDesc::Quality::draft;
    desc.render.integrator = RenderDesc::Integrator::volume;
    desc.render.scattering = RenderDesc::Scattering::single;
    desc.render.samples = 1;
    CameraDesc& camera = desc.camera;
    width = std::min(camera.width, width);
    const double height = static_cast<double>(camera.height) * width / camera.width;
    resize_image(camera, width, std::clamp(static_cast<int>(std::lround(height)), 1, 1024));
}

}  // namespace uw
