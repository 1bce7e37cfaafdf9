#include "render/measures/light_numbers.h"

#include <vector>

#include "core/integrators/integrator_table.h"

namespace uw {

namespace {

std::vector<PicturePlane> planes_of(const MeasuredImage& image,
                                    std::initializer_list<Layer> layers) {
    std::vector<PicturePlane> planes = layer_planes(image.film, image.plan, layers);
    if (image.emitted == nullptr) return planes;
    for (PicturePlane& plane : layer_planes(*image.emitted, image.plan, layers, -1))
        planes.push_back(plane);
    return planes;
}

Distribution distribution_of(const MeasuredImage& image, std::initializer_list<Layer> layers,
                             std::span<const std::size_t> pixels) {
    const std::vector<PicturePlane> planes = planes_of(image, layers);
    const GreyLayers light(planes, image.plan.band_count());
    std::vector<double> values;
    values.reserve(pixels.size());
    for (const std::size_t pixel : pixels) values.push_back(light.at(pixel));
    return {mean_of(values), percentile(values, 0.05), percentile(values, 0.5),
            percentile(values, 0.95)};
}

}  // namespace

std::string layers_to_measure(const SceneDesc& scene) {
    std::string layers = k_picture_layers;
    if (scattering_of(scene.render) == RenderDesc::Scattering::multiple)
        layers += ",multiple.volume,multiple.surface";
    return layers;
}

LightNumbers light_numbers(const MeasuredImage& image, std::span<const std::size_t> pixels) {
    LightNumbers numbers;
    numbers.pixels = pixels.size();
    numbers.direct = distribution_of(image, {Layer::direct}, pixels);
    numbers.forward = distribution_of(image, {Layer::forward}, pixels);
    numbers.backscatter = distribution_of(image, {Layer::backscatter}, pixels);
    if (image.plan.has(Layer::multiple_volume))
        numbers.multiple =
            distribution_of(image, {Layer::multiple_volume, Layer::multiple_surface}, pixels);
    PictureLayers picture = picture_layers(image.film, image.plan);
    picture.signal = planes_of(image, {Layer::direct, Layer::forward, Layer::multiple_surface});
    picture.backscatter = planes_of(image, {Layer::backscatter, Layer::multiple_volume});
    picture.clean = planes_of(image, {Layer::clean});
    numbers.picture = measure_picture(picture, pixels);
    return numbers;
}

}  // namespace uw
