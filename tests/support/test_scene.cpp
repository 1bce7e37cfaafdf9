#include "tests/support/test_scene.h"

#include <cmath>

#include "core/base/parallel.h"

namespace uw::test {

SceneDesc pinhole_scene(int width, int height) {
    SceneDesc desc;
    desc.file = "test.yaml";
    desc.camera.width = width;
    desc.camera.height = height;
    const double focal = 0.5 * width / std::tan(glm::radians(30.0));
    desc.camera.intrinsics = {focal, focal, 0.5 * width, 0.5 * height};
    desc.water = hg_water(0.9);
    desc.render.samples = 1;
    return desc;
}

WaterDesc hg_water(double g) {
    WaterDesc water;
    water.bands_nm = {620, 540, 450};
    water.absorption = PerBand{0.35, 0.08, 0.05};
    ScatteringDesc scattering;
    scattering.b = {0.20, 0.22, 0.25};
    scattering.phase.function = HenyeyGreensteinDesc{g};
    water.scattering = scattering;
    return water;
}

LampDesc isotropic_lamp(const Point3& position, double intensity) {
    LampDesc lamp;
    lamp.name = "lamp";
    lamp.position = position;
    lamp.intensity = PerBand{intensity, intensity, intensity};
    return lamp;
}

GeometryDesc plane_at_z(double z) {
    GeometryDesc plane;
    plane.type = GeometryDesc::Type::plane;
    plane.point = {0, 0, z};
    plane.normal = {0, 0, -1};
    return plane;
}

TestScene::TestScene(const SceneDesc& desc, const DeepShadowOptions& options)
    : scene_(assemble_scene(SceneDesc(desc), cache_, [](Stage /*stage*/) {})) {
    scene_.slabs = place_slabs(scene_);
    const PassNeeds needs = make_passes(scene_.image).needs(layer_plan(scene_.image, {}));
    if (needs.light) light_ = cache_.light(scene_, options);
    transport_ = make_light_transport(scene_, light_, needs.paths);
    pixels_ = std::make_unique<PixelRenderer>(pixel_renderer(assembled(), transport_));
}

PixelResult TestScene::pixel(int x, int y) const {
    PixelResult result;
    pixels_->render(x, y, result);
    return result;
}

std::vector<PixelResult> TestScene::image() const {
    const int width = assembled().camera->width(), height = assembled().camera->height();
    std::vector<PixelResult> pixels(static_cast<std::size_t>(width * height));
    parallel_for(pixels.size(), [&](std::size_t i) {
        pixels_->render(static_cast<int>(i) % width, static_cast<int>(i) / width, pixels[i]);
    });
    return pixels;
}

}  // namespace uw::test
