#include "cli/scene_assembly.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/focus_weighted_integrator.h"
#include "core/forward_images.h"
#include "core/geometry_scene.h"
#include "core/planes_integrator.h"
#include "core/reference_integrator.h"
#include "core/volume_integrator.h"

namespace uw {

namespace {

void append(std::vector<std::string>& to, std::vector<std::string> from) {
    to.insert(to.end(), from.begin(), from.end());
}

// A lamp where the camera's rays begin has in-scatter that grows without bound (1/r^2).
void warn_of_lamps_at_the_camera(AssembledScene& scene) {
    const CameraDesc& camera = scene.desc.camera;
    const std::optional<Ray> ray = scene.camera->water_ray(0.5 * camera.width, 0.5 * camera.height);
    if (!ray) {
        scene.warnings.push_back(fmt::format(
            "{}: camera: no ray of the image centre enters the water; check camera.port",
            scene.desc.file.filename().string()));
        return;
    }
    for (std::size_t j = 0; j < scene.lamps.size(); ++j) {
        if (distance(scene.lamps[j].position(), ray->origin) < k_lamp_radius)
            scene.warnings.push_back(fmt::format(
                "{}: the lamp stands where the camera's rays enter the water; its in-scatter "
                "grows without bound there and is cut at {} m from it; move it aside",
                scene.desc.lamps[j].where, k_lamp_radius));
    }
}

void check_forward_scatter_of(const SceneDesc& scene, const Medium& medium) {
    const ForwardScatterDesc& desc = scene.water.forward_scatter;
    if (desc.K == 0) return;
    std::vector<double> attenuation;
    for (int band = 0; band < medium.band_count(); ++band)
        attenuation.push_back(medium.uniform.attenuation(band));
    check_forward_scatter(desc, attenuation, desc.where);
    check_blur_length(medium, desc.where);
}

}  // namespace

AssembledScene assemble_scene(const SceneDesc& desc, const StageCallback& begin_stage) {
    if (desc.render.integrator == RenderDesc::Integrator::planes && !desc.volumes.empty())
        throw InputError(
            fmt::format("{}: the planes integrator is for uniform water: remove `volumes`, or use "
                        "integrator volume",
                        desc.volumes.front().where));
    AssembledScene scene;
    scene.desc = desc;
    scene.warnings = desc.warnings;
    scene.camera = std::make_unique<Camera>(desc.camera);
    scene.water = build_water_model(desc.water, desc.volumes);
    append(scene.warnings, scene.water.warnings);
    const Medium& medium = scene.water.medium;
    check_forward_scatter_of(desc, medium);
    begin_stage("volumes");
    scene.field = load_volumes(desc.volumes, scene.water.loads, medium.constituent_count(),
                               scene.volume_reports, scene.warnings);
    begin_stage("geometry");
    scene.surfaces = build_surfaces(desc.geometry, medium.wavelengths_nm, scene.warnings);
    for (const LampDesc& lamp : desc.lamps)
        scene.lamps.emplace_back(lamp, desc.camera.world_from_camera, medium.band_count());
    warn_of_lamps_at_the_camera(scene);
    scene.slabs = place_slabs(desc.render.planes, *scene.camera, scene.lit());
    return scene;
}

std::vector<std::shared_ptr<const LampLightField>> splat_lamps(const AssembledScene& scene,
                                                               const LightFieldOptions& options,
                                                               const ShareCallback& progress) {
    std::vector<std::shared_ptr<const LampLightField>> fields;
    LightFieldOptions share = options;
    share.column_budget /= std::max(std::size_t{1}, scene.lamps.size());
    for (const Lamp& lamp : scene.lamps) {
        fields.push_back(std::make_shared<LampLightField>(*scene.field, *scene.surfaces,
                                                          lamp.position(), share));
        progress(static_cast<double>(fields.size()) / static_cast<double>(scene.lamps.size()));
    }
    return fields;
}

static std::unique_ptr<Integrator> make_unweighted_integrator(
    const AssembledScene& scene,
    const std::vector<std::shared_ptr<const LampLightField>>& light_fields) {
    if (scene.desc.render.integrator == RenderDesc::Integrator::reference)
        return std::make_unique<ReferenceIntegrator>(scene.lit());
    if (scene.desc.render.integrator == RenderDesc::Integrator::planes)
        return std::make_unique<PlanesIntegrator>(scene.lit(), scene.desc.camera.world_from_camera,
                                                  scene.slabs);
    VolumeQuadrature quadrature;
    if (scene.desc.render.quality == RenderDesc::Quality::draft) quadrature.voxels_per_panel = 6;
    return std::make_unique<VolumeIntegrator>(
        scene.lit(),
        std::vector<std::shared_ptr<const LightField>>(light_fields.begin(), light_fields.end()),
        quadrature);
}

std::unique_ptr<Integrator> make_integrator(
    const AssembledScene& scene,
    const std::vector<std::shared_ptr<const LampLightField>>& light_fields) {
    std::unique_ptr<Integrator> integrator = make_unweighted_integrator(scene, light_fields);
    if (scene.desc.render.output != RenderDesc::Output::paper) return integrator;
    return std::make_unique<FocusWeightedIntegrator>(std::move(integrator),
                                                     scene.desc.camera.lens.value().focal_length);
}

}  // namespace uw
