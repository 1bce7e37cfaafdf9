#include "core/integrators/reference_integrator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/stop.h"
#include "core/integrators/ray_panels.h"

namespace uw {

namespace {

// Light whose path exceeds the least optical depth by this much adds less than 1e-6.
constexpr double k_negligible_optical_depth = 15;
// Of steps among particles [optical depths], as a multiple of the step that is given: a tenth.
constexpr double k_depth_of_steps = 20;
// What is behind this optical depth adds less than 1e-17 of all light.
constexpr double k_dark = 40;

LightTransport make_reference(const IntegratorInputs& inputs) {
    return {std::make_unique<ReferenceIntegrator>(inputs.scene),
            std::make_unique<DirectLighting>(inputs.scene)};
}

}  // namespace

constinit const IntegratorKind ReferenceIntegrator::k_kind{.make = make_reference};

ReferenceIntegrator::ReferenceIntegrator(const LitScene& scene, double step)
    : scene_(scene), attenuation_(*scene.medium), step_(step) {}

void ReferenceIntegrator::in_scatter(const Ray& ray, std::span<const double> distances,
                                     InScatter& result) const {
    const std::vector<Lamp>& emitters = *scene_.emitters;
    result.reset(distances.size(), scene_.lamp_count());
    const Interval grid = inside(ray, scene_.field->bounds());
    const double voxel = scene_.field->finest_voxel();
    const double least_c =
        attenuation_.uniform.least(static_cast<std::size_t>(attenuation_.band_count));
    const double greatest_c =
        attenuation_.uniform.greatest(static_cast<std::size_t>(attenuation_.band_count));
    for (std::size_t j = 0; j < emitters.size(); ++j) {
        const LampPassage passage(ray, emitters[j]);
        const double reach =
            least_c > 0 ? passage.reach(k_negligible_optical_depth / least_c) : k_far;
        const auto scale_at = [&](double s) {
            // Ten times as far as the densest band's light reaches only the others' is left, of
            // which steps of that length in proportion are as small a part.
            if (passage.parallel)
                return greatest_c > 0 ? std::max(1 / greatest_c, 0.1 * s) / (1 + passage.rate())
                                      : k_far;
            return std::max(passage.radius(s), k_lamp_radius);
        };
        // The water's surface may be less than a step away.
        const Interval lit =
            passage.parallel ? emitters[j].beam(ray, {0, reach}) : Interval{0, reach};
        Spectrum sum;
        double s = lit.begin;
        double depth = 0;  // of the grid before s, in the band that sees farthest
        for (std::size_t i = 0; i < distances.size(); ++i) {
            const double end = std::min(distances[i], lit.end);
            while (s < end && depth < k_dark) {
                throw_if_stopped();
                double length = step_ * scale_at(s);
                const bool in_grid = s < grid.end && s + length > grid.begin;
                const auto [least, greatest] =
                    in_grid ? attenuation_at(ray.at(s)) : std::pair(0.0, 0.0);
                if (in_grid)
                    length = std::min({length, 0.25 * voxel, k_depth_of_steps * step_ / greatest});
                length = std::min(length, end - s);
                depth += length * least;
                sum += length * in_scatter_per_metre(ray, s + 0.5 * length, j);
                s = end - s > length ? s + length : end;
            }
            result.at(i, emitters[j].index()) += sum;
        }
    }
}

std::pair<double, double> ReferenceIntegrator::attenuation_at(const Point3& x) const {
    std::vector<double> concentration(scene_.medium->constituents.size());
    scene_.field->sample(x, concentration);
    std::array<double, k_max_bands> values{};
    const auto bands = std::span(values).first(static_cast<std::size_t>(attenuation_.band_count));
    for (std::size_t b = 0; b < bands.size(); ++b)
        bands[b] = attenuation_.optical_depth(b, 1, concentration);
    const auto [least, greatest] = std::ranges::minmax(bands);
    return {least, greatest};
}

Spectrum ReferenceIntegrator::in_scatter_per_metre(const Ray& ray, double s,
                                                   std::size_t lamp_index) const {
    const Lamp& lamp = (*scene_.emitters)[lamp_index];
    const Medium& medium = *scene_.medium;
    const Point3 x = ray.at(s);
    const Point3 origin = lamp.origin(x);
    const Vector3 from_lamp = x - origin;
    const double radius = glm::length(from_lamp);
    const double relative = lamp.relative_intensity(from_lamp);
    if (lamp.holds(radius) || relative <= 0 || scene_.surfaces->occluded(origin, x)) return {};
    // psi is the angle between the directions of travel: w_in = from_lamp, w_out = -ray.direction.
    const double psi = std::atan2(glm::length(glm::cross(from_lamp, ray.direction)),
                                  -glm::dot(from_lamp, ray.direction));
    const std::size_t constituents = medium.constituents.size();
    std::vector<double> from_lamp_column(constituents), to_camera_column(constituents),
        concentration(constituents);
    scene_.field->column(origin, x, from_lamp_column);
    scene_.field->column(ray.origin, x, to_camera_column);
    scene_.field->sample(x, concentration);
    for (std::size_t k = 0; k < constituents; ++k) from_lamp_column[k] += to_camera_column[k];
    const Spectrum transmittance = attenuation_.transmittance(radius + s, from_lamp_column);
    Spectrum result;
    for (std::size_t m = 0; m < medium.phase_functions.size(); ++m) {
        const double p = medium.phase_functions[m]->evaluate(psi);
        Spectrum b = medium.uniform.scattering[m];
        for (std::size_t k = 0; k < constituents; ++k)
            b += concentration[k] * medium.constituents[k].per_unit.scattering[m];
        result += lamp.axis_intensity() * relative * transmittance * b * p / lamp.spread(radius);
    }
    return result;
}

}  // namespace uw
