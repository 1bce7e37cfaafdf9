#include "render/mirror_image.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/light/integrator_table.h"
#include "core/passes/mirrored_view.h"
#include "core/passes/pixel_layers.h"
#include "render/scene_rendering.h"

namespace uw {

namespace {

// Refuses features that are made for the camera's own rays and not for those of its mirror image.
void check_mirrored(const SceneDesc& scene) {
    const auto refuse = [&](const char* key, const char* why, const char* hint) {
        throw InputError(fmt::format(
            "{}: {} with a water surface that reflects, where the camera sees it: {}; {}",
            scene.file.filename().string(), key, why, hint));
    };
    if (integrator_kind(scene.render.integrator).sums_slabs)
        refuse("render.integrator: planes", "its slabs lie across the camera's axis",
               "use volume or reference");
    if (scene.render.output == RenderDesc::Output::paper)
        refuse("render.output: paper", "its light is weighted by the distance from the camera",
               "use another output");
    if (scene.water.snow)
        refuse("water.snow", "particles are not placed in the mirror",
               "remove one of them, or point the camera down");
}

}  // namespace

void run_light_passes(const AssembledScene& scene, PassList& passes, Rendering& rendering) {
    const RaySource& rays = rendering.pixels.rays();
    const bool has_mirror =
        scene.water_surface && MirroredView::may_see(rays, *scene.water_surface);
    if (has_mirror) check_mirrored(scene.desc());
    if (has_mirror && rendering.deep != nullptr)
        throw UsageError(
            "--deep: the camera sees the water mirrored in its surface, at no distance of its own; "
            "point the camera down, or leave out the surface");
    passes.run(Pass::Of::light, rendering);
    if (!has_mirror) return;
    const MirroredView view(rays, scene.lit());
    Film film(rendering.film.width(), rendering.film.height(), rendering.film.window(),
              rendering.film.channel_names());
    const StageProgressCallback progress = [&](Stage stage, double fraction) {
        rendering.progress(Stage::reflection, stage == Stage::render ? fraction : 0);
    };
    ImageProgress reached;
    Rendering mirrored =
        make_rendering(scene, view, rendering.pixels.transport(), rendering.light,
                       {rendering.plan, rendering.colour, film, progress, reached});
    mirrored.pixels.set_weight([&](int x, int y) { return view.arriving(x, y); });
    passes.run(Pass::Of::light, mirrored);
    add_mirrored(film, rendering.plan, rendering.colour, rendering.film);
    rendering.reached.include(reached);
}

}  // namespace uw
