#include "core/integrators/surface_lighting.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/base/fast_exp.h"
#include "core/base/stop.h"
#include "core/integrators/surface_columns.h"

namespace uw {

namespace {

// A tile of thousands of samples per pixel has a million shadow rays to each lamp.
constexpr std::size_t k_rays_at_once = 1024;

/// The samples that one lamp may illuminate: they face it and lie within its beam.
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
            const Vector3 to_lamp = lamp.origin(hit.position) - hit.position;
            // The geometric normal decides what a lamp can illuminate; the shading normal only
            // affects shading.
            const double towards = glm::dot(hit.normal, to_lamp);
            if (towards <= 0 || glm::dot(hit.geometric_normal, to_lamp) <= 0) continue;
            const double relative = lamp.relative_intensity(-to_lamp);
            if (relative <= 0) continue;
            const double radius = glm::length(to_lamp);
            samples.push_back(i);
            positions.push_back(hit.position);
            radii.push_back(radius);
            geometry_terms.push_back(relative * towards / (lamp.spread(radius) * radius));
        }
        hidden.resize(samples.size());
    }

    void trace_shadows(const Lamp& lamp, const Surfaces& surfaces) {
        if (!lamp.sunlight()) {
            for (std::size_t n = 0; n < positions.size(); n += k_rays_at_once) {
                throw_if_stopped();
                const std::size_t count = std::min(k_rays_at_once, positions.size() - n);
                surfaces.occluded_many(lamp.position(), std::span(positions).subspan(n, count),
                                       std::span(hidden).subspan(n, count));
            }
            return;
        }
        for (std::size_t n = 0; n < positions.size(); ++n) {
            throw_if_stopped();
            hidden[n] = surfaces.occluded(lamp.origin(positions[n]), positions[n]) ? 1 : 0;
        }
    }
};

}  // namespace

DirectLighting::DirectLighting(const LitScene& scene,
                               std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                               double column_tolerance)
    : scene_(scene),
      attenuation_(*scene.medium),
      deep_shadows_(std::move(deep_shadows)),
      column_tolerance_(column_tolerance) {}

void DirectLighting::evaluate(std::span<const SurfaceSample* const> samples,
                              SurfaceLight& light) const {
    const auto bands = static_cast<std::size_t>(attenuation_.band_count);
    thread_local std::vector<double> column;
    thread_local Facing facing;
    thread_local SurfaceColumns columns;
    column.resize(attenuation_.constituents.size());
    light.reset(samples.size(), *scene_.emitters, bands);
    // Compute optical depths first; all are converted to transmittances at once.
    const auto set_depths = [&](std::size_t sample, double length, std::span<double> depths) {
        throw_if_stopped();
        columns.column(sample, column);
        for (std::size_t b = 0; b < bands; ++b)
            depths[b] = attenuation_.optical_depth(b, length, column);
    };
    columns.begin(scene_, attenuation_, {&deep_shadows_, column_tolerance_}, samples);
    columns.take_camera();
    const PathWeight& weight = scene_.path_weight;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        set_depths(i, samples[i]->hit.distance, light.to_camera(i));
        if (weight) light.camera_weights().push_back(weight.of(samples[i]->hit.distance, column));
    }
    for (std::size_t j = 0; j < scene_.emitters->size(); ++j) {
        const Lamp& lamp = (*scene_.emitters)[j];
        facing.find(lamp, samples);
        facing.trace_shadows(lamp, *scene_.surfaces);
        columns.take_emitter(j);
        for (std::size_t n = 0; n < facing.samples.size(); ++n) {
            if (facing.hidden[n] != 0) continue;
            const std::size_t i = facing.samples[n];
            light.geometry_term(i, j) = facing.geometry_terms[n];
            set_depths(i, facing.radii[n], light.from_emitter(i, j));
            if (weight)
                light.geometry_term(i, j) *=
                    light.glow_weight(i) + weight.of(facing.radii[n], column);
        }
    }
    exp_of_minus(light.transmittances());
}

}  // namespace uw
