#include "core/integrators/surface_lighting.h"

#include <vector>

#include "core/base/fast_exp.h"

namespace uw {

namespace {

/// The samples that one lamp may reach: they face it, within its beam.
struct Facing {
    std::vector<std::size_t> samples;
    std::vector<Point3> positions;
    std::vector<double> radii, geometry_terms;
    std::vector<char> hidden;

    void find(const Lamp& lamp, std::span<const SurfaceSample* const> all) {
        samples.clear();
        positions.clear();
        radii.clear();
        geometry_terms.clear();
        for (std::size_t i = 0; i < all.size(); ++i) {
            const SurfaceHit& hit = all[i]->hit;
            const Vector3 to_lamp = lamp.position() - hit.position;
            // The true surface decides what a lamp can reach; the shading normal only shades.
            const double towards = glm::dot(hit.normal, to_lamp);
            if (towards <= 0 || glm::dot(hit.geometric_normal, to_lamp) <= 0) continue;
            const double relative = lamp.relative_intensity(-to_lamp);
            if (relative <= 0) continue;
            const double radius = glm::length(to_lamp);
            samples.push_back(i);
            positions.push_back(hit.position);
            radii.push_back(radius);
            geometry_terms.push_back(relative * towards / (radius * radius * radius));
        }
        hidden.resize(samples.size());
    }
};

}  // namespace

void light_surfaces(const LitScene& scene, const AttenuationTable& attenuation,
                    std::span<const SurfaceSample* const> samples, SurfaceLight& light,
                    const ColumnMixing& mixing) {
    const auto bands = static_cast<std::size_t>(attenuation.band_count);
    thread_local std::vector<double> column;
    thread_local Facing facing;
    thread_local SurfaceColumns columns;
    column.resize(attenuation.constituents.size());
    light.reset(samples.size(), *scene.lamps, bands);
    // Optical depths first; all become transmittances at once.
    const auto set_depths = [&](std::size_t sample, double length, std::span<double> depths) {
        columns.column(sample, column);
        for (std::size_t b = 0; b < bands; ++b)
            depths[b] = attenuation.optical_depth(static_cast<int>(b), length, column);
    };
    columns.begin(scene, attenuation, mixing, samples);
    columns.take_camera();
    for (std::size_t i = 0; i < samples.size(); ++i)
        set_depths(i, samples[i]->hit.distance, light.to_camera(i));
    for (std::size_t j = 0; j < scene.lamps->size(); ++j) {
        const Lamp& lamp = (*scene.lamps)[j];
        facing.find(lamp, samples);
        scene.surfaces->occluded_many(lamp.position(), facing.positions, facing.hidden);
        columns.take_lamp(j);
        for (std::size_t n = 0; n < facing.samples.size(); ++n) {
            if (facing.hidden[n] != 0) continue;
            const std::size_t i = facing.samples[n];
            light.geometry_term(i, j) = facing.geometry_terms[n];
            set_depths(i, facing.radii[n], light.from_lamp(i, j));
        }
    }
    exp_of_minus(light.transmittances());
}

}  // namespace uw
