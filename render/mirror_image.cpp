#include "render/mirror_image.h"

#include "core/passes/mirrored_view.h"
#include "core/passes/pixel_layers.h"
#include "render/scene_rendering.h"

namespace uw {

void run_light_passes(const AssembledScene& scene, PassList& passes, Rendering& rendering) {
    passes.run(Pass::Of::light, rendering);
    const RaySource& rays = rendering.pixels.rays();
    if (!scene.water_surface || !MirroredView::may_see(rays, *scene.water_surface)) return;
    const MirroredView view(rays, scene.lit());
    PixelRenderer pixels = pixel_renderer(scene, view, rendering.pixels.transport(),
                                          rendering.pixels.in_scatter().parts());
    pixels.set_weight([&](int x, int y) { return view.arriving(x, y); });
    Film film(rendering.film.width(), rendering.film.height(), rendering.film.window(),
              rendering.film.channel_names());
    const ProgressCallback progress = [&](const std::string& stage, double share) {
        rendering.progress("reflection", stage == "render" ? share : 0);
    };
    ImageProgress reached;
    Rendering mirrored{.desc = rendering.desc,
                       .time = rendering.time,
                       .pixels = pixels,
                       .light = rendering.light,
                       .snow = rendering.snow,
                       .plan = rendering.plan,
                       .colour = rendering.colour,
                       .film = film,
                       .progress = progress,
                       .reached = reached};
    passes.run(Pass::Of::light, mirrored);
    add_mirrored(film, rendering.plan, rendering.colour, rendering.film);
    rendering.reached.include(reached);
}

}  // namespace uw
