#include "render/light_left_out.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "core/light/integrator_table.h"
#include "core/passes/path_pass.h"
#include "core/paths/path_tracer.h"
#include "core/paths/scattering_tables.h"
#include "render/scene_assembly.h"
#include "render/scene_rendering.h"

namespace uw {

namespace {

constexpr int k_paths = 8;  // of each kind at each place
// Light scattered more often guides no path; finding it takes the most time.
constexpr int k_guiding_orders = 8;

}  // namespace

std::optional<LightLeftOut> estimate_light_left_out(const AssembledScene& scene) {
    if (scattering_of(scene.desc().render) == RenderDesc::Scattering::multiple) return std::nullopt;
    LightTransport transport = make_path_transport(
        scene, std::make_shared<const ScatteringTables>(scene.water.medium, k_guiding_orders));
    const PixelRenderer pixels = pixel_renderer(scene, transport);
    const PathTrial trial = PathPixels(pixels, 0).try_out(k_paths);
    double more = 0, variance = 0;
    for (const PathTrial::OfKind& kind : trial.kinds) {
        more += kind.mean;
        variance += kind.variance / k_paths;
    }
    const double all = trial.once + more;
    if (!(all > 0)) return std::nullopt;
    return LightLeftOut{more / all, std::sqrt(variance) * trial.once / (all * all)};
}

std::string settings_of_all_light(const SceneDesc& scene) {
    std::string how = "render.scattering: multiple";
    if (!integrator_kind(scene.render.integrator).multiple_scattering)
        how += " and render.integrator: volume";
    if (scene.water.forward_scatter.K > 0) how += " and water.forward_scatter.K: 0";
    return how;
}

std::optional<std::string> left_out_note(const AssembledScene& scene,
                                         const std::optional<LightLeftOut>& left_out) {
    if (!left_out || !left_out->matters()) return std::nullopt;
    const SceneDesc& desc = scene.desc();
    // The paper's image has no other.
    if (desc.render.output == RenderDesc::Output::paper) return std::nullopt;
    return fmt::format(
        "single scattering leaves out about {:.0f} % of this image's light, which is scattered or "
        "reflected more than once; {} renders it",
        100 * left_out->share, settings_of_all_light(desc));
}

}  // namespace uw
