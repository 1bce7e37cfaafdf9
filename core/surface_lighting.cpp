#include "core/surface_lighting.h"

#include <algorithm>

namespace uw {

void light_surface(const LitScene& scene, const AttenuationTable& attenuation, const Ray& ray,
                   const SurfaceHit& hit, SurfaceLight& light) {
    const auto bands = static_cast<std::size_t>(attenuation.band_count);
    thread_local std::vector<double> column;
    column.resize(attenuation.constituents.size());
    scene.field->column(ray.origin, hit.position, column);
    light.transmittance = attenuation.transmittance(hit.distance, column);
    light.lamps.resize(scene.lamps->size());
    for (std::size_t j = 0; j < scene.lamps->size(); ++j) {
        const Lamp& lamp = (*scene.lamps)[j];
        LampIrradiance& out = light.lamps[j];
        out.visible = false;
        std::fill_n(out.irradiance.begin(), bands, 0.0);
        std::fill_n(out.clean.begin(), bands, 0.0);
        const Vector3 to_lamp = lamp.position() - hit.position;
        const double radius = glm::length(to_lamp);
        const double cosine = glm::dot(hit.normal, to_lamp) / radius;
        const double relative = lamp.relative_intensity(-to_lamp);
        // The true surface decides what a lamp can reach; the shading normal only shades.
        if (cosine <= 0 || relative <= 0 || glm::dot(hit.geometric_normal, to_lamp) <= 0) continue;
        if (scene.surfaces->occluded(lamp.position(), hit.position)) continue;
        scene.field->column(lamp.position(), hit.position, column);
        const Spectrum transmittance = attenuation.transmittance(radius, column);
        out.visible = true;
        for (std::size_t b = 0; b < bands; ++b) {
            out.clean[b] = lamp.axis_intensity()[b] * relative * cosine / (radius * radius);
            out.irradiance[b] = out.clean[b] * transmittance[b];
        }
    }
}

}  // namespace uw
