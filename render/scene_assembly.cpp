#include "render/scene_assembly.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/base/troubleshooting.h"
#include "core/geometry/glass.h"
#include "core/geometry/surface_reflection.h"
#include "core/light/integrator_table.h"
#include "core/light/lamp_factory.h"
#include "core/light/medium.h"
#include "core/light/planes_integrator.h"
#include "core/light/sky_emitter.h"
#include "core/light/submerged.h"
#include "core/passes/forward_images.h"
#include "core/paths/path_tracer.h"
#include "core/scene/waves_desc.h"
#include "media/volumes/load_volumes.h"
#include "render/scene_cache.h"

namespace uw {

namespace {

// Drafts use a quarter of the points of lamps with an extent.
constexpr int k_draft_thinning = 4;

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

// In-scattered light from a lamp at the origin of the camera's rays diverges (1/r^2).
void warn_of_lamps_at_the_camera(const SceneDesc& desc, AssembledScene& scene) {
    const CameraDesc& camera = desc.camera;
    const std::optional<Ray> ray =
        scene.camera->refracted_ray(0.5 * camera.width, 0.5 * camera.height);
    if (!ray) {
        scene.warnings.push_back(fmt::format(
            "{}: camera: no ray from the image centre enters the water; check camera.port",
            desc.file.filename().string()));
        return;
    }
    const std::optional<WaterSurfaceDesc>& surface = desc.water.surface;
    if (surface && !surface->n && glm::dot(surface->normal, ray->origin - surface->point) > 0)
        scene.warnings.push_back(fmt::format(
            "{}: camera: it lies above water.surface, but all that it sees counts as water; move "
            "it below",
            desc.file.filename().string()));
    for (const Lamp& emitter : scene.emitters) {
        if (emitter.contains(distance(emitter.position(), ray->origin)))
            scene.warnings.push_back(fmt::format(
                "{}: the lamp is where the camera's rays enter the water; its in-scatter grows "
                "without bound there and is cut off at {} m from it; move it aside{}",
                desc.lamps[emitter.index()].where, k_lamp_radius,
                see_troubleshooting("Blotches, grain and spots")));
    }
}

void check_forward_scatter_of(const SceneDesc& scene, const Medium& medium) {
    const ForwardScatterDesc& desc = scene.water.forward_scatter;
    if (desc.K == 0) return;
    std::vector<double> attenuation;
    attenuation.reserve(medium.wavelengths_nm.size());
    for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band)
        attenuation.push_back(medium.uniform.attenuation(band));
    check_forward_scatter(desc, attenuation, desc.where);
    check_blur_length(medium, desc.where);
}

void report_volumes(AssembledScene& scene) {
    const bool interpolates_columns =
        integrator_kind(scene.desc().render.integrator).needs_deep_shadows;
    for (const LoadedVolume& volume : scene.volumes) {
        append(scene.warnings, volume.warnings);
        for (const VolumeReport& report : volume.reports)
            if (const auto warning = coarse_voxel_warning(report, scene.water.medium);
                warning && interpolates_columns)
                scene.warnings.push_back(*warning);
        scene.volume_reports.insert(scene.volume_reports.end(), volume.reports.begin(),
                                    volume.reports.end());
    }
}

// Precondition: the scene's emissions were made.
void place_lamps(const SceneDesc& desc, AssembledScene& scene) {
    const int thinning = desc.render.quality == RenderDesc::Quality::draft ? k_draft_thinning : 1;
    auto emissive = scene.emissions.begin();
    for (const LampDesc& lamp : desc.lamps) {
        const std::size_t first = scene.emitters.size();
        if (lamp.emissive_volume) {
            const std::vector<EmissivePart> parts = merged((emissive++)->volume->parts, thinning);
            scene.lamps.push_back(make_lamp(lamp, parts));
            append_emitters(scene.lamps.back(), scene.lamps.size() - 1, parts, scene.emitters);
            if (scattering_of(desc.render) == RenderDesc::Scattering::multiple)
                for (Lamp& emitter : std::span(scene.emitters).subspan(first))
                    emitter = emitter.met_by_paths();
            if (scene.water_surface)
                append_mirror_images(*scene.water_surface, first, scene.emitters);
            continue;
        }
        if (lamp.sky) {
            const Sky& sky = scene.sky.value();
            scene.lamps.push_back(make_lamp(lamp, sky));
            append_emitters(lamp, scene.lamps.back(), scene.lamps.size() - 1, thinning, sky,
                            scene.emitters);
            continue;
        }
        scene.lamps.push_back(make_lamp(lamp, desc.camera.world_from_camera,
                                        scene.water.medium.wavelengths_nm, scene.warnings));
        const std::size_t index = scene.lamps.size() - 1;
        if (index < scene.sun_foci.size() && scene.sun_foci[index]) {
            // The sun's disc is in the map already.
            scene.emitters.push_back(
                scene.lamps.back().with_index(index).focused(scene.sun_foci[index]));
            continue;
        }
        append_emitters(lamp, scene.lamps.back(), index, thinning, desc.camera.world_from_camera,
                        scene.emitters);
        if (scene.water_surface) append_mirror_images(*scene.water_surface, first, scene.emitters);
        append_surface(lamp, scene.lamps.back(), index, thinning, desc.camera.world_from_camera,
                       scene.lamp_surfaces);
    }
}

SeenSky seen_sky(const std::optional<Sky>& sky, const SceneDesc& desc) {
    if (!sky) return {};
    const auto lamp =
        std::ranges::find_if(desc.lamps, [](const LampDesc& each) { return each.sky != nullptr; });
    return {[sky = *sky, sky_from_world = glm::transpose(sky->world_from_sky())](
                const Vector3& towards) { return sky.radiance(sky_from_world * towards); },
            static_cast<std::size_t>(lamp - desc.lamps.begin())};
}

// Adds the water's surface to the surfaces and the field, if it reflects.
void submerge(const SceneDesc& desc, SceneCache& cache, AssembledScene& scene) {
    const std::optional<WaterSurfaceDesc>& surface = desc.water.surface;
    if (!surface || !surface->n) return;
    scene.water_surface = cache.water_surface(*surface, scene.image.time().value_or(0));
    for (const LampDesc& lamp : desc.lamps)
        if (lamp.sky) scene.sky.emplace(*lamp.sky, surface->normal, desc.water.bands_nm);
    const SubmergedParts& parts = cache.submerged(*surface, scene.surfaces, scene.field);
    scene.shadow_casters = parts.shadow_casters;
    if (scene.sky || scene.water_surface->has_waves())
        scene.surfaces = std::make_shared<SubmergedSurfaces>(scene.surfaces, *scene.water_surface,
                                                             seen_sky(scene.sky, desc));
    else
        scene.surfaces = parts.shadow_casters;
    scene.field = parts.field;
    scene.field_with_image = parts.field_with_image;
}

// Sets what light does at the surfaces of glass, if there are any. Precondition: the scene has its
// surfaces and its water surface.
void set_glass(const SceneDesc& desc, const std::shared_ptr<const Surfaces>& surfaces,
               AssembledScene& scene) {
    scene.glass = nullptr;
    if (!dynamic_cast<const GlassSurfaces*>(surfaces.get())) return;
    scene.glass = std::make_shared<GlassOptics>(
        surfaces, scene.water_surface ? scene.water_surface->n() : k_surface_water_index,
        desc.water.bands_nm.size(), scene.water_surface);
}

// Refuses what does not know of glass. Precondition: the scene is complete.
void check_glass(const SceneDesc& desc, AssembledScene& scene) {
    if (!scene.glass) return;
    const auto refuse = [&](const char* what, const char* mend) {
        throw InputError(fmt::format("{}: {} {}", desc.file.filename().string(), what, mend));
    };
    if (integrator_kind(desc.render.integrator).sums_slabs)
        refuse("render.integrator: planes knows no glass;", "use volume, or remove the glass");
    if (desc.render.output == RenderDesc::Output::paper)
        refuse("render.output: paper knows no glass;", "use another output, or remove the glass");
    if (desc.water.forward_scatter.K > 0)
        refuse("water.forward_scatter knows no glass;",
               "write render.scattering: multiple instead, which has all scattering, or remove the "
               "glass");
    if (!scene.glass->around(at_origin_plus(scene.camera->world_from_camera().offset())).empty())
        refuse("the camera is inside solid glass of the scene;",
               "describe the glass in front of a camera by camera.port");
    if (scene.sky)
        scene.warnings.push_back(fmt::format(
            "{}: the sky's light on surfaces and in the water passes glass as if there were none; "
            "what is seen through glass is right",
            desc.file.filename().string()));
}

// Dims the light of emitters by glass on its way. The sky's parts are no single lines.
void shade_by_glass(AssembledScene& scene) {
    if (!scene.glass) return;
    std::vector<Lamp> emitters;
    const auto bands = static_cast<std::size_t>(scene.water.medium.band_count());
    for (const Lamp& emitter : scene.emitters) {
        if (dynamic_cast<const SkyEmitter*>(&emitter.emitter())) {
            emitters.push_back(emitter);
        } else if (scene.glass->is_coloured()) {
            for (const Lamp& of_band : emitter.behind_coloured_glass(scene.glass, bands))
                emitters.push_back(of_band);
        } else {
            emitters.push_back(emitter.behind_glass(scene.glass));
        }
    }
    scene.emitters = std::move(emitters);
}

// Returns the extent of the maps of caustics: a tile of the sea or, without one, a square around
// the camera.
SunFocus::Extent extent_of_focus(const SceneDesc& desc, const AssembledScene& scene) {
    constexpr double k_side = 32, k_min_depth = 2, k_margin = 1.2;
    const WaterSurface& surface = *scene.water_surface;
    const Vector3 camera =
        surface.coordinates(at_origin_plus(scene.camera->world_from_camera().offset()));
    SunFocus::Extent extent{.side = k_side, .u = camera.x, .v = camera.y};
    if (const auto* sea = std::get_if<WaveSpectrumDesc>(&desc.water.surface->waves->shape))
        extent = {.side = sea->tile, .is_periodic = true};
    double depth = std::max(k_min_depth, -camera.z);
    const auto include = [&](const Point3& x) { depth = std::max(depth, -surface.height(x)); };
    if (const Bounds bounds = scene.surfaces->bounds(); !bounds.empty())
        for (int corner = 0; corner < 8; ++corner)
            include({(corner & 1 ? bounds.max : bounds.min).x,
                     (corner & 2 ? bounds.max : bounds.min).y,
                     (corner & 4 ? bounds.max : bounds.min).z});
    for (const GeometryDesc& geometry : desc.geometry)
        if (geometry.type == GeometryDesc::Type::plane) include(geometry.point);
    extent.depth = k_margin * depth;
    return extent;
}

// Precondition: the scene has surfaces.
void focus_suns(const SceneDesc& desc, SceneCache& cache, AssembledScene& scene) {
    constexpr int k_resolution = 512, k_draft_resolution = 256;
    if (!scene.water_surface || !scene.water_surface->has_waves()) return;
    const bool is_draft = desc.render.quality == RenderDesc::Quality::draft;
    const SunFocus::Extent extent = extent_of_focus(desc, scene);
    for (const LampDesc& lamp : desc.lamps)
        scene.sun_foci.push_back(lamp.sun && !lamp.sky
                                     ? cache.sun_focus(lamp.direction,
                                                       glm::radians(lamp.sun->angle), extent,
                                                       is_draft ? k_draft_resolution : k_resolution)
                                     : nullptr);
}

// Precondition: the lamps are placed.
void check_below_surface(const SceneDesc& desc, const AssembledScene& scene) {
    if (!scene.water_surface) return;
    if (desc.water.forward_scatter.K > 0)
        throw InputError(fmt::format(
            "{}: forward scatter knows no water surface that reflects; remove one of the two, or "
            "write render.scattering: multiple, which has all scattering",
            desc.water.forward_scatter.where));
    const auto refuse = [&](const auto& where, const char* what, double height) {
        throw InputError(fmt::format(
            "{}: {} is {:.3g} m above water.surface, or among its waves; what is seen or lit from "
            "the air is not rendered; move it below",
            where, what, height));
    };
    const double camera =
        scene.water_surface->height(at_origin_plus(scene.camera->world_from_camera().offset()));
    if (camera > scene.water_surface->lowest())
        refuse(desc.file.filename().string(), "the camera", camera);
    for (const Lamp& emitter : scene.emitters) {
        if (emitter.sunlight() || emitter.is_mirrored()) continue;
        const double height = scene.water_surface->height(emitter.position());
        if (height > 0) refuse(desc.lamps[emitter.index()].where, "the lamp", height);
    }
}

LightTransport make_by(RenderDesc::Integrator integrator, const LitScene& lit,
                       const AssembledScene& scene, const DeepShadows& deep_shadows) {
    return integrator_kind(integrator)
        .make({lit,
               scene.desc().camera.world_from_camera,
               scene.slabs.value_or(Slabs{}),
               scene.desc().render.quality,
               {deep_shadows.begin(), deep_shadows.end()}});
}

LightTransport transport_in(const Medium& medium, const AssembledScene& scene,
                            const DeepShadows& deep_shadows) {
    LitScene lit = scene.lit();
    lit.medium = &medium;
    return make_by(scene.desc().render.integrator, lit, scene, deep_shadows);
}

void weigh_as_output(const SceneDesc& desc, LightTransport& transport) {
    if (desc.render.output == RenderDesc::Output::paper)
        transport.replace_integrator(std::make_unique<FocusWeightedIntegrator>(
            std::move(transport.integrator), desc.camera.lens.value().focal_length));
}

}  // namespace

AssembledScene assemble_scene(const ImageScene& image, SceneCache& cache,
                              const StageCallback& begin_stage, const ProgressCallback& particles) {
    AssembledScene scene(image);
    const SceneDesc& desc = scene.desc();
    check_integrator(desc);
    scene.warnings = desc.warnings;
    scene.camera = std::make_unique<Camera>(desc.camera);
    scene.water = cache.water(desc, particles);
    scene.scattering = cache.scattering();
    append(scene.warnings, scene.water.warnings);
    const Medium& medium = scene.water.medium;
    check_forward_scatter_of(desc, medium);
    if (desc.water.snow) {
        scene.snow = make_snow_model(*desc.water.snow, *scene.camera, medium);
        if (scene.snow->warning) scene.warnings.push_back(*scene.snow->warning);
    }
    cache.keep_only(desc, scene.water);
    begin_stage(Stage::volumes);
    VolumeSet volumes = cache.volumes(desc, scene.water);
    scene.volumes = std::move(volumes.volumes);
    scene.field = std::move(volumes.field);
    report_volumes(scene);
    begin_stage(Stage::geometry);
    const SurfaceSet& built = cache.surfaces(desc);
    scene.surfaces = scene.shadow_casters = built.surfaces;
    scene.geometry_warnings = built.warnings;
    append(scene.warnings, scene.geometry_warnings);
    submerge(desc, cache, scene);
    set_glass(desc, built.surfaces, scene);
    focus_suns(desc, cache, scene);
    scene.emissions = cache.emissions(desc, scene.warnings);
    place_lamps(desc, scene);
    shade_by_glass(scene);
    check_below_surface(desc, scene);
    check_glass(desc, scene);
    warn_of_lamps_at_the_camera(desc, scene);
    return scene;
}

Slabs place_slabs(const AssembledScene& scene) {
    return place_slabs(scene.desc().render.planes, *scene.camera, scene.lit());
}

AssembledScene with_moved(const AssembledScene& scene, ImageScene then,
                          std::unique_ptr<Camera> camera, SceneCache& cache) {
    AssembledScene moved(std::move(then));
    const SceneDesc& desc = moved.desc();
    moved.camera = std::move(camera);
    moved.water = scene.water;
    moved.scattering = scene.scattering;
    moved.snow = scene.snow;
    moved.field = scene.field;
    moved.emissions = scene.emissions;
    moved.surfaces = scene.surfaces;
    moved.shadow_casters = scene.shadow_casters;
    moved.water_surface = scene.water_surface;
    moved.sky = scene.sky;
    moved.glass = scene.glass;
    moved.sun_foci = scene.sun_foci;
    moved.field_with_image = scene.field_with_image;
    if (desc.geometry != scene.desc().geometry) {
        const std::shared_ptr<const Surfaces> below = cache.surfaces_of_moment(desc).surfaces;
        moved.surfaces = moved.shadow_casters = below;
        if (moved.water_surface) {
            moved.surfaces = std::make_shared<SubmergedSurfaces>(below, *moved.water_surface,
                                                                 seen_sky(moved.sky, desc));
            moved.shadow_casters = std::make_shared<SubmergedSurfaces>(
                below, WaterSurface(without_waves(*desc.water.surface)), SeenSky());
        }
        set_glass(desc, below, moved);
    }
    place_lamps(desc, moved);
    shade_by_glass(moved);
    moved.warnings.clear();
    if (scene.slabs) moved.slabs = place_slabs(moved);
    return moved;
}

LightTransport make_light_transport(const AssembledScene& scene, const DeepShadows& deep_shadows,
                                    bool with_paths) {
    const auto make = [&](const Medium& medium) {
        return transport_in(medium, scene, deep_shadows);
    };
    LightTransport transport = make(scene.water.medium);
    if (scene.snow)
        transport.replace_integrator(
            std::make_unique<BeyondSnow>(make(scene.snow->water).integrator,
                                         make(scene.snow->alone).integrator, scene.snow->parts()));
    if (with_paths && integrator_kind(scene.desc().render.integrator).traces_paths)
        transport.paths = std::make_shared<PathTracer>(
            scene.lit(), std::vector<std::shared_ptr<const DeepShadow>>(), scene.scattering);
    else if (with_paths)
        transport.paths = std::make_shared<PathTracer>(scene.lit(), deep_shadows, scene.scattering);
    weigh_as_output(scene.desc(), transport);
    return transport;
}

LightTransport make_path_transport(const AssembledScene& scene,
                                   std::shared_ptr<const ScatteringTables> scattering) {
    LightTransport transport =
        make_by(RenderDesc::Integrator::path, scene.lit(), scene, DeepShadows());
    transport.paths = std::make_shared<PathTracer>(
        scene.lit(), std::vector<std::shared_ptr<const DeepShadow>>(), std::move(scattering));
    return transport;
}

namespace {

constexpr int k_columns = 16, k_rows = 12;  // rays over the image

/// Returns the surfaces that a lattice of the camera's rays hits.
std::vector<SurfaceHit> surfaces_in_view(const AssembledScene& scene) {
    std::vector<SurfaceHit> hits;
    for (int j = 0; j < k_rows; ++j) {
        for (int i = 0; i < k_columns; ++i) {
            const auto ray =
                scene.camera->refracted_ray((i + 0.5) * scene.camera->width() / k_columns,
                                            (j + 0.5) * scene.camera->height() / k_rows);
            SurfaceHit hit;
            if (ray && scene.surfaces->closest_hit(*ray, k_far, hit)) hits.push_back(hit);
        }
    }
    return hits;
}

bool lights(const AssembledScene& scene, const Lamp& lamp, const SurfaceHit& hit) {
    const Point3 from = lamp.origin(hit.position);
    const Vector3 from_lamp = hit.position - from;
    return glm::dot(from_lamp, hit.normal) < 0 && lamp.relative_intensity(from_lamp) > 0 &&
           !scene.surfaces->occluded(from, hit.position);
}

}  // namespace

std::optional<double> depth_of_nearest_lamp(const AssembledScene& scene) {
    const AttenuationTable attenuation(scene.water.medium);
    std::vector<double> columns(static_cast<std::size_t>(scene.field->constituent_count()));
    std::optional<double> nearest;
    const auto take = [&](const Lamp& lamp, const Point3& to) {
        const Point3 from = lamp.origin(to);
        scene.field->column(from, to, columns);
        double clearest = k_far;
        for (std::size_t band = 0; band < static_cast<std::size_t>(attenuation.band_count); ++band)
            if (lamp.axis_intensity()[band] > 0)
                clearest = std::min(clearest,
                                    attenuation.optical_depth(band, distance(from, to), columns));
        if (clearest < k_far)
            nearest = std::min(nearest.value_or(k_far), clearest);  // otherwise, the lamp is dark
    };
    const std::vector<SurfaceHit> hits = surfaces_in_view(scene);
    const Point3 camera = at_origin_plus(scene.camera->world_from_camera().offset());
    for (const Lamp& lamp : scene.lamps) {
        take(lamp, camera);
        for (const SurfaceHit& hit : hits)
            if (lights(scene, lamp, hit)) take(lamp, hit.position);
    }
    return nearest;
}

}  // namespace uw
