#include "render/scene_rendering.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/error.h"
#include "core/base/troubleshooting.h"
#include "core/light/integrator_table.h"
#include "core/passes/deep_pass.h"
#include "core/passes/forward_scatter_pass.h"
#include "core/passes/glass_pass.h"
#include "core/passes/multiple_scattering_pass.h"
#include "core/passes/pixel_pass.h"
#include "core/passes/sensor_pass.h"
#include "core/passes/truth_pass.h"
#include "render/snow/snow_pass.h"

namespace uw {

namespace {

// Tolerance for the columns of a lamp's map between two of its rays, as optical depth; the rays
// used are half as far apart. A camera's ray meets hundreds of such errors, of either sign. Errors
// along a ray, which add up, have a smaller tolerance (ColumnFace).
constexpr double k_column_tolerance = 0.02;
// Maximum number of rays per pixel, in path-traced images, for layers that are not means over
// paths.
constexpr int k_max_samples_beside_paths = 16;
// At this optical depth of the nearest lamp, the relative deviation of a path is 2 to 3. The table
// that guides paths to the lamp ends at 48.
constexpr double k_max_depth = 20;

// Whether MultipleScatteringPass renders the multiple scattering of an image.
bool paths_at_nodes(const RenderDesc& render) {
    return scattering_of(render) == RenderDesc::Scattering::multiple &&
           !integrator_kind(render.integrator).traces_paths;
}

}  // namespace

PassList make_passes(const ImageScene& image, const PathRequest& paths, std::int64_t frame) {
    const SceneDesc& scene = image.desc();
    const RenderDesc& render = scene.render;
    PassList passes;  // check_integrator refuses invalid combinations
    if (paths_at_nodes(render)) passes.add<MultipleScatteringPass>(paths.path_factor);
    if (!integrator_kind(render.integrator).traces_paths)
        passes.add<GlassPass>(paths_at_nodes(render));
    if (scene.water.snow) passes.add<SnowPass>(*scene.water.snow);
    passes.add<DeepPass>();
    if (integrator_kind(render.integrator).traces_paths)
        passes.add<PathPass>(render, paths);
    else
        passes.add<PixelPass>(render);
    if (scene.water.forward_scatter.K > 0) passes.add<ForwardScatterPass>();
    const auto has_grids = [](const VolumeDesc& volume) { return !volume.grids.empty(); };
    const auto moves = [&](const VolumeDesc& volume) { return has_grids(volume) && volume.motion; };
    passes.add<TruthPass>(
        TruthPass::Subjects{.frames = image.choice().frame.has_value(),
                            .cameras = scene.cameras.size() > 1,
                            .plume = std::ranges::any_of(scene.volumes, has_grids),
                            .moving_plume = std::ranges::any_of(scene.volumes, moves)});
    if (scene.camera.sensor) passes.add<SensorPass>(*scene.camera.sensor, frame);
    return passes;
}

void check_deep(const AssembledScene& assembled) {
    const SceneDesc& scene = assembled.desc();
    const auto refuse = [](bool is_given, std::string_view what, std::string_view hint) {
        if (is_given)
            throw UsageError(fmt::format(
                "--deep: the distances of its light are not known with {}; {}", what, hint));
    };
    const IntegratorKind& integrator = integrator_kind(scene.render.integrator);
    refuse(integrator.traces_paths || integrator.sums_slabs, "this integrator",
           "use --integrator volume");
    refuse(scene.render.output == RenderDesc::Output::paper, "render.output: paper",
           "use another output");
    refuse(scene.water.forward_scatter.K > 0, "water.forward_scatter",
           "give --set water.forward_scatter.K=0, or render.scattering=multiple");
    refuse(scene.water.snow.has_value(), "water.snow", "leave the snow out");
    refuse(assembled.glass != nullptr, "glass", "leave the surfaces of glass out");
}

LayerPlan layer_plan(const ImageScene& image, std::string_view request, const PathRequest& paths) {
    const SceneDesc& scene = image.desc();
    const bool traces_paths = integrator_kind(scene.render.integrator).traces_paths;
    for (const auto& [requested, option] :
         {std::pair{paths.error.has_value(), "--error"}, std::pair{paths.orders > 0, "--orders"}})
        if (requested && !traces_paths)
            throw UsageError(fmt::format(
                "{}: is for --integrator path only; write that, or leave this out", option));
    std::vector<std::string> names;
    names.reserve(scene.lamps.size());
    for (const LampDesc& lamp : scene.lamps) names.push_back(lamp.name);
    return {request, scene.water.bands_nm, names, make_passes(image, paths).supply()};
}

DeepShadowOptions deep_shadow_options(RenderDesc::Quality quality, const Medium& medium) {
    DeepShadowOptions options;
    if (quality == RenderDesc::Quality::exact)
        options.shadow_resolution = 2048;
    else
        options.column_tolerance = DepthTolerance(medium, k_column_tolerance);
    if (quality != RenderDesc::Quality::draft) return options;
    options.shadow_resolution = 128;
    options.columns_per_voxel = 0.75;
    return options;
}

PixelRenderer pixel_renderer(const AssembledScene& scene, const LightTransport& transport,
                             const InScatterParts& parts, const PointMatchers& matchers) {
    return pixel_renderer(scene, *scene.camera, transport, parts, matchers);
}

PixelRenderer pixel_renderer(const AssembledScene& scene, const RaySource& rays,
                             const LightTransport& transport, const InScatterParts& parts,
                             const PointMatchers& matchers) {
    int samples = samples_of(scene.desc().render);
    if (integrator_kind(scene.desc().render.integrator).traces_paths)
        samples = std::min(samples, k_max_samples_beside_paths);
    return {rays,
            scene.lit(),
            transport,
            {samples, scene.total_samples, scene.first_sample},
            scene.slabs.value_or(Slabs{}),
            SensorModel(scene.desc()),
            parts,
            matchers};
}

Rendering make_rendering(const AssembledScene& scene, const RaySource& rays,
                         const LightTransport& transport,
                         std::span<const std::shared_ptr<const DeepShadow>> light,
                         const ImageTarget& target, const PointMatchers& matchers) {
    PixelRenderer pixels =
        pixel_renderer(scene, rays, transport, in_scatter_parts(target.plan), matchers);
    constexpr std::array k_of_plume{Layer::plume_optical_depth, Layer::plume_opacity,
                                    Layer::plume_range_50, Layer::plume_range_10,
                                    Layer::plume_flow};
    if (std::ranges::any_of(k_of_plume, [&](Layer layer) { return target.plan.has(layer); }))
        pixels.find_plume();
    return {target, scene.desc(),    scene.image.time().value_or(0), std::move(pixels),
            light,  scene.snow.get()};
}

std::vector<ColourGroup> colour_groups_of(const SceneDesc& scene) {
    const bool is_draft = scene.render.quality == RenderDesc::Quality::draft;
    return colour_groups(scene.camera, scene.water.bands_nm, is_draft ? 1 : k_shared_rays);
}

std::optional<std::string> far_lamp_warning(const AssembledScene& scene) {
    if (!paths_at_nodes(scene.desc().render)) return std::nullopt;
    const std::optional<double> depth = depth_of_nearest_lamp(scene);
    if (!depth || *depth <= k_max_depth) return std::nullopt;
    return fmt::format(
        "multiple scattering: the nearest lamp lies behind an optical depth of {:.2g}, as seen "
        "from the camera and from the surfaces it lights; beyond {:g} its noise is large; use "
        "--integrator path with --error 0.02, or move a lamp nearer{}",
        *depth, k_max_depth, see_troubleshooting("Blotches, grain and spots"));
}

}  // namespace uw
