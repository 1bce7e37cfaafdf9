#include "core/frame/tile_renderer.h"

namespace uw {

namespace {

/// Makes the ground truth of a pixel that of a particle of snow at this distance along its ray: a
/// disk that faces the camera, with the number after those of all objects for its id.
void hold(double distance, const PixelView& view, const PixelRenderer& renderer,
          PixelResult& result) {
    result.has_hit = true;
    result.hit = {};
    result.hit.distance = distance;
    result.hit.position = view.ray->at(distance);
    result.hit.normal = result.hit.geometric_normal = -view.ray->direction;
    result.hit.object_id =
        static_cast<std::uint32_t>(renderer.scene().surfaces->names().objects.size()) + 1;
    const Point3 in_camera = renderer.rays().world_from_camera().inverse() * result.hit.position;
    result.depth_z = in_camera.z;
    result.range = glm::length(from_origin(in_camera));
    result.path = distance;
}

}  // namespace

TileRenderer::TileRenderer(const PixelRenderer& renderer, double in_scatter_tolerance,
                           const PixelAdditions& additions)
    : renderer_(renderer), additions_(additions) {
    if (in_scatter_tolerance > 0)
        lattice_.emplace(renderer.rays(), renderer.scene(), renderer.in_scatter(),
                         in_scatter_tolerance);
    else
        in_scatter_.resize(renderer.in_scatter().value_count());
}

void TileRenderer::begin(const PixelWindow& tile) {
    tile_ = tile;
    renderer_.trace(tile, views_);
    renderer_.light_surfaces(views_.values(), light_);
    first_samples_.clear();
    std::size_t samples = 0;
    for (const PixelView& view : views_) {
        first_samples_.push_back(samples);
        samples += view.samples.size();
    }
    if (lattice_) lattice_->evaluate(tile, views_);
}

RenderedPixel TileRenderer::render(int x, int y) {
    const std::size_t pixel = views_.index(x - tile_.x0, y - tile_.y0);
    const PixelView& view = views_[pixel];
    const std::size_t first_sample = first_samples_[pixel];
    if (!lattice_) renderer_.in_scatter().integrate(view, in_scatter_);
    renderer_.shade(view, light_, first_sample, lattice_ ? lattice_->values(pixel) : in_scatter_,
                    result_);
    if (additions_.multiple) additions_.multiple->add(view, light_, first_sample, result_);
    if (additions_.snow && view.ray) add_snow(x, y, view);
    return {view, light_, first_sample, result_};
}

void TileRenderer::add_snow(int x, int y, const PixelView& view) {
    const double end = view.has_hit ? view.path : view.distances.back();
    result_.snow = additions_.snow->radiance(x, y, end, result_.direct + result_.multiple_surface,
                                             result_.backscatter + result_.multiple_volume);
    const double held = additions_.snow->held(x, y);
    if (additions_.snow_in_ground_truth && held > 0) hold(held, view, renderer_, result_);
}

}  // namespace uw
