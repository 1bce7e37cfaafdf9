#include "core/integrators/reference_integrator.h"

#include <algorithm>
#include <cmath>

#include "core/integrators/ray_panels.h"

namespace uw {

namespace {

// Light whose path exceeds the least optical depth by this much adds less than 1e-6.
constexpr double k_negligible_optical_depth = 15;

// The interval of `ray` inside `bounds`; empty (begin > end) if it misses them.
Interval inside(const Ray& ray, const Bounds& bounds) {
    Interval stretch{0, k_far};
    if (bounds.empty()) return {1, 0};
    for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis];
        const double to_min = bounds.min[axis] - ray.origin[axis];
        const double to_max = bounds.max[axis] - ray.origin[axis];
        if (d == 0 && (to_min > 0 || to_max < 0)) return {1, 0};
        if (d == 0) continue;
        stretch.begin = std::max(stretch.begin, std::min(to_min / d, to_max / d));
        stretch.end = std::min(stretch.end, std::max(to_min / d, to_max / d));
    }
    return stretch;
}

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
    for (std::size_t j = 0; j < emitters.size(); ++j) {
        const LampPassage passage(ray, emitters[j].position());
        const double reach =
            least_c > 0 ? passage.radius(0) + k_negligible_optical_depth / least_c : k_far;
        Spectrum sum;
        double s = 0;
        for (std::size_t i = 0; i < distances.size(); ++i) {
            const double end = distances[i];
            while (s < std::min(end, reach)) {
                double length = step_ * std::max(passage.radius(s), k_lamp_radius);
                const bool in_grid = s < grid.end && s + length > grid.begin;
                if (in_grid) length = std::min(length, 0.25 * voxel);
                length = std::min(length, end - s);
                sum += length * in_scatter_per_metre(ray, s + 0.5 * length, j);
                s = end - s > length ? s + length : end;
            }
            result.at(i, emitters[j].index()) += sum;
        }
    }
}

Spectrum ReferenceIntegrator::in_scatter_per_metre(const Ray& ray, double s,
                                                   std::size_t lamp_index) const {
    const Lamp& lamp = (*scene_.emitters)[lamp_index];
    const Medium& medium = *scene_.medium;
    const Point3 x = ray.at(s);
    const Vector3 from_lamp = x - lamp.position();
    const double radius = glm::length(from_lamp);
    const double relative = lamp.relative_intensity(from_lamp);
    if (radius < k_lamp_radius || relative <= 0 || scene_.surfaces->occluded(lamp.position(), x))
        return {};
    // psi is the angle between the directions of travel: w_in = from_lamp, w_out = -ray.direction.
    const double psi = std::atan2(glm::length(glm::cross(from_lamp, ray.direction)),
                                  -glm::dot(from_lamp, ray.direction));
    const std::size_t constituents = medium.constituents.size();
    std::vector<double> from_lamp_column(constituents), to_camera_column(constituents),
        concentration(constituents);
    scene_.field->column(lamp.position(), x, from_lamp_column);
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
        result += lamp.axis_intensity() * relative * transmittance * b * p / (radius * radius);
    }
    return result;
}

}  // namespace uw
