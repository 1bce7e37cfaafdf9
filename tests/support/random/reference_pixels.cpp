#include "tests/support/random/reference_pixels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/scene_rendering.h"

namespace uw::test {
namespace {

constexpr auto k_total = "total";

}  // namespace

bool is_at_plane(const Lamp& lamp, const SceneDesc& scene) {
    constexpr double k_near = 1e-3;  // 1e-5 of 100 m
    if (lamp.sunlight()) return false;
    return std::ranges::any_of(scene.geometry, [&](const GeometryDesc& desc) {
        if (desc.type != GeometryDesc::Type::plane) return false;
        const Vector3 normal = glm::normalize(desc.world_from_object.apply_to_normal(desc.normal));
        const Vector3 off = lamp.position() - desc.world_from_object * desc.point;
        const double distance = std::abs(glm::dot(off, normal));
        return distance > 0 && distance < k_near;
    });
}

ReferencePixels::ReferencePixels(const ImageScene& scene)
    : bands_(scene.desc().water.bands_nm.size()) {
    renderer_.set_scene(scene.with(
        [](SceneDesc& desc) { desc.render.integrator = RenderDesc::Integrator::reference; }));
    // With three bands, R G B are the total.
    first_ = bands_ == 3 ? 0
                         : static_cast<std::size_t>(
                               layer_plan(renderer_.scene(), k_total).first_channel(Layer::total));
}

std::vector<double> ReferencePixels::at(int x, int y) {
    renderer_.render({.layers = k_total, .window = PixelWindow{x, y, x + 1, y + 1}});
    const Film film = renderer_.release_film();
    const auto total = film.pixel(x, y).subspan(first_, bands_);
    return {total.begin(), total.end()};
}

}  // namespace uw::test
