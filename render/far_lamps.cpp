#include "render/far_lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/integrators/integrator_table.h"
#include "core/optics/optical_depth.h"

namespace uw {

namespace {

// One path's relative deviation is 2 to 8 at this optical depth, and 6 to 60 at twice that.
constexpr double k_most_depth = 5;
constexpr int k_columns = 16, k_rows = 12;  // rays over the image

/// What the camera sees, at a lattice of rays.
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
    const Vector3 way = hit.position - from;
    return glm::dot(way, hit.normal) < 0 && lamp.relative_intensity(way) > 0 &&
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
        nearest = std::min(nearest.value_or(k_far), clearest);
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

std::optional<std::string> far_lamp_warning(const AssembledScene& scene) {
    const RenderDesc& render = scene.desc.render;
    if (scattering_of(render) != RenderDesc::Scattering::multiple ||
        integrator_kind(render.integrator).traces_paths)
        return std::nullopt;
    const std::optional<double> depth = depth_of_nearest_lamp(scene);
    if (!depth || *depth <= k_most_depth) return std::nullopt;
    return fmt::format(
        "multiple scattering: the nearest lamp lies behind an optical depth of {:.2g}, as seen "
        "from "
        "the camera and from the surfaces it lights; beyond {:g} its noise is large; use "
        "--integrator "
        "path with --error 0.02, or move a lamp nearer",
        *depth, k_most_depth);
}

}  // namespace uw
