#include "tests/support/random/reference_pixels.h"

#include <utility>

#include "render/scene_rendering.h"

namespace uw::test {
namespace {

constexpr auto k_total = "total";

}  // namespace

ReferencePixels::ReferencePixels(SceneDesc scene) : bands_(scene.water.bands_nm.size()) {
    scene.render.integrator = RenderDesc::Integrator::reference;
    // With three bands, R G B are the total.
    first_ = bands_ == 3
                 ? 0
                 : static_cast<std::size_t>(layer_plan(scene, k_total).first_channel(Layer::total));
    renderer_.set_scene(std::move(scene));
}

std::vector<double> ReferencePixels::at(int x, int y) {
    renderer_.render({.layers = k_total, .window = PixelWindow{x, y, x + 1, y + 1}});
    const Film film = renderer_.release_film();
    const auto total = film.pixel(x, y).subspan(first_, bands_);
    return {total.begin(), total.end()};
}

}  // namespace uw::test
