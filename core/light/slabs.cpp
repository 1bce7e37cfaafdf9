#include "core/light/slabs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"

namespace uw {

namespace {

// The optical depth that is kept beyond the farthest lamp, both from the lamp and to the camera:
// e^-10 = 5e-5 of the light remains. A sun's light may come straight down, so that only the path to
// the camera counts, with twice that.
constexpr double k_max_optical_depth = 5;
// Maximum number of survey rays along each side of the image, edges included.
constexpr int k_survey_rays = 256;
// Upper bound on the number of slabs including those behind `far`, whatever their thickness.
constexpr double k_max_slabs = 1 << 20;

// The extent of the water along a coarse lattice of camera rays, in camera z [m].
struct View {
    double near = k_far;  // where it begins
    double deepest = 0;   // of the surfaces
    bool open = false;    // some ray hits no surface
};

View survey(const RaySource& rays, const Surfaces& surfaces) {
    const Affine camera_from_world = rays.world_from_camera().inverse();
    const int columns = std::min(k_survey_rays, rays.width()),
              rows = std::min(k_survey_rays, rays.height());
    struct Row {
        View view;
        bool all_enter = true, any_enters = false;
    };
    std::vector<Row> surveyed(static_cast<std::size_t>(rows) + 1);
    parallel_for(surveyed.size(), [&](std::size_t j) {
        Row& row = surveyed[j];
        for (int i = 0; i <= columns; ++i) {
            const auto ray = rays.refracted_ray(static_cast<double>(i) * rays.width() / columns,
                                                static_cast<double>(j) * rays.height() / rows);
            if (!ray) {
                row.all_enter = false;
                continue;
            }
            row.any_enters = true;
            const RayDepth depth(camera_from_world, *ray);
            row.view.near = std::min(row.view.near, std::max(0.0, depth.z(0)));
            const double surface = surfaces.hit_distance(*ray);
            row.view.open = row.view.open || surface > k_far;
            if (surface <= k_far) row.view.deepest = std::max(row.view.deepest, depth.z(surface));
        }
    });
    View view;
    bool all_enter = true, any_enters = false;
    for (const Row& row : surveyed) {
        view.near = std::min(view.near, row.view.near);
        view.deepest = std::max(view.deepest, row.view.deepest);
        view.open = view.open || row.view.open;
        all_enter = all_enter && row.all_enter;
        any_enters = any_enters || row.any_enters;
    }
    // The least z of a flat port is at the image's border, provided that all border rays pass
    // through it.
    if (!all_enter) view.near = 0;
    if (!any_enters) view.open = true;  // the image is black anyway
    return view;
}

// Camera z beyond which no significant lamp light returns.
double max_depth(const RaySource& rays, const LitScene& scene, double near) {
    const AttenuationTable attenuation(*scene.medium);
    const double min_c =
        attenuation.uniform.least(static_cast<std::size_t>(attenuation.band_count));
    if (min_c <= 0) return k_far;
    const Point3 camera = rays.world_from_camera() * Point3{};
    double farthest = k_max_optical_depth / min_c;
    for (const Lamp& lamp : *scene.emitters) {
        const double depth = (lamp.sunlight() ? 2 : 1) * k_max_optical_depth;
        farthest = std::max(farthest, distance(lamp.origin(camera), camera) + depth / min_c);
    }
    return std::min(k_far, near + farthest);
}

}  // namespace

Slabs place_slabs(const PlanesDesc& desc, const RaySource& rays, const LitScene& scene) {
    const View view = survey(rays, *scene.surfaces);
    const double last = max_depth(rays, scene, view.near);
    const double visible = view.open ? last : std::min(last, view.deepest);
    Slabs slabs;
    slabs.near = desc.near.value_or(view.near);
    slabs.far = desc.far.value_or(visible);
    slabs.count = desc.count;
    if (slabs.far <= view.near || slabs.near >= visible)
        throw InputError(fmt::format(
            "{}: the slabs from z = {:.6g} m to {:.6g} m contain no visible water: it lies from "
            "{:.6g} m to {:.6g} m; choose near and far to enclose it, or omit them",
            desc.where, slabs.near, slabs.far, view.near, visible));
    if (!desc.far) {
        const double count = std::ceil((last - slabs.near) / slabs.thickness());
        const double thickness = slabs.thickness();
        slabs.count = std::max(desc.count, static_cast<int>(std::min(count, k_max_slabs)));
        if (slabs.count > desc.count) slabs.far = slabs.near + slabs.count * thickness;
    }
    return slabs;
}

}  // namespace uw
