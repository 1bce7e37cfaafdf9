#include "core/surface_lighting.h"

#include <algorithm>
#include <vector>

#include "core/fast_exp.h"

namespace uw {

void light_surface(const LitScene& scene, const AttenuationTable& attenuation, const Ray& ray,
                   const SurfaceHit& hit, SurfaceLight& light) {
    const auto bands = static_cast<std::size_t>(attenuation.band_count);
    const std::size_t lamps = scene.lamps->size();
    thread_local std::vector<double> column;
    column.resize(attenuation.constituents.size());
    // Optical depths to the camera, then from each lamp; all become transmittances at once.
    thread_local std::vector<double> transmittance;
    transmittance.assign((1 + lamps) * bands, 0.0);
    const auto set_depths = [&](std::size_t path, double length) {
        for (std::size_t b = 0; b < bands; ++b)
            transmittance[path * bands + b] =
                attenuation.optical_depth(static_cast<int>(b), length, column);
    };
    scene.field->column(ray.origin, hit.position, column);
    set_depths(0, hit.distance);
    light.lamps.resize(lamps);
    for (std::size_t j = 0; j < lamps; ++j) {
        const Lamp& lamp = (*scene.lamps)[j];
        LampIrradiance& out = light.lamps[j];
        out.visible = false;
        std::fill_n(out.clean.begin(), bands, 0.0);
        const Vector3 to_lamp = lamp.position() - hit.position;
        const double radius = glm::length(to_lamp);
        const double cosine = glm::dot(hit.normal, to_lamp) / radius;
        // The true surface decides what a lamp can reach; the shading normal only shades.
        if (cosine <= 0 || glm::dot(hit.geometric_normal, to_lamp) <= 0) continue;
        const double relative = lamp.relative_intensity(-to_lamp);
        if (relative <= 0 || scene.surfaces->occluded(lamp.position(), hit.position)) continue;
        scene.field->column(lamp.position(), hit.position, column);
        set_depths(1 + j, radius);
        out.visible = true;
        for (std::size_t b = 0; b < bands; ++b)
            out.clean[b] = lamp.axis_intensity()[b] * relative * cosine / (radius * radius);
    }
    exp_of_minus(transmittance);
    std::copy_n(transmittance.begin(), bands, light.transmittance.begin());
    for (std::size_t j = 0; j < lamps; ++j)
        for (std::size_t b = 0; b < bands; ++b)
            light.lamps[j].irradiance[b] =
                light.lamps[j].clean[b] * transmittance[(1 + j) * bands + b];
}

}  // namespace uw
