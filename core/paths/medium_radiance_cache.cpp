#include "core/paths/medium_radiance_cache.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/parallel.h"
#include "core/light/lamp.h"
#include "core/light/ray_panels.h"

namespace uw {

namespace {

constexpr double k_cells_of_particles = 8000;
// The relative intensity of a lamp outside its beam, where light arrives after scattering.
constexpr double k_relative_beyond_beam = 0.05;
// The march ends where the transmittance has fallen to this.
constexpr double k_negligible_transmittance = 0.02;

}  // namespace

MediumRadianceCache::MediumRadianceCache(const WaterOptics& optics, const LampRadianceTable& field,
                                         const NextEventEstimator& lamps,
                                         const EmissionSampler& emission)
    : bounds_(optics.scene().field->grids().bounds()) {
    const Vector3 extent = bounds_.empty() ? Vector3(0) : bounds_.max - bounds_.min;
    if (optics.constituents() == 0 || !(extent.x > 0 && extent.y > 0 && extent.z > 0)) return;
    edge_ = std::cbrt(extent.x * extent.y * extent.z / k_cells_of_particles);
    edge_ = std::max(edge_, std::max({extent.x, extent.y, extent.z}) / k_cells_of_particles);
    for (int axis = 0; axis < 3; ++axis)
        count_[static_cast<std::size_t>(axis)] =
            std::max(1, static_cast<int>(std::ceil(extent[axis] / edge_)));
    const LitScene& scene = optics.scene();
    const Medium& medium = *scene.medium;
    const std::vector<Lamp>& all = *scene.emitters;
    const std::size_t bands = optics.bands(), constituents = optics.constituents();
    cells_.resize(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                  static_cast<std::size_t>(count_[2]));
    parallel_for(cells_.size(), [&](std::size_t n) {
        std::vector<double> column(constituents), concentration(constituents, 0.0);
        const auto across = static_cast<std::size_t>(count_[0]);
        const auto down = static_cast<std::size_t>(count_[1]);
        const Point3 x =
            bounds_.min + edge_ * Vector3(static_cast<double>(n % across) + 0.5,
                                          static_cast<double>(n / across % down) + 0.5,
                                          static_cast<double>(n / across / down) + 0.5);
        // The cell's concentrations are means over three lines through it.
        for (int axis = 0; axis < 3; ++axis) {
            Vector3 half(0);
            half[axis] = 0.5 * edge_;
            scene.field->column(x - half, x + half, column);
            for (std::size_t k = 0; k < constituents; ++k)
                concentration[k] += column[k] / (3 * edge_);
        }
        Cell& cell = cells_[n];
        double scattering = 0, attenuation = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            attenuation += medium.uniform.attenuation(b);
            for (std::size_t k = 0; k < constituents; ++k) {
                const OpticalCoefficients& unit = medium.constituents[k].per_unit;
                scattering += concentration[k] * unit.total_scattering()[b];
                attenuation += concentration[k] * unit.attenuation(b);
            }
        }
        cell.scattering = static_cast<float>(scattering / static_cast<double>(bands));
        cell.attenuation = static_cast<float>(attenuation / static_cast<double>(bands));
        if (!(scattering > 0)) return;
        double light = 0;
        for (std::size_t j = 0; j < all.size(); ++j) {
            if (all[j].is_met_by_paths()) continue;
            const Point3 origin = all[j].origin(x);
            const double radius = std::max(glm::length(x - origin), 0.5 * edge_);
            const double relative =
                std::max(all[j].relative_intensity(x - origin), k_relative_beyond_beam);
            if (scene.surfaces->occluded(origin, x)) continue;
            lamps.column_to_lamp(j, x, column);
            for (std::size_t b = 0; b < bands; ++b) {
                const double depth = optics.attenuation().optical_depth(b, radius, column);
                light +=
                    relative / all[j].spread(radius) * all[j].axis_intensity()[b] *
                    field.flux(field.at(depth, medium.uniform.total_scattering()[b] /
                                                   std::max(medium.uniform.attenuation(b), 1e-9)));
            }
        }
        cell.light = static_cast<float>(
            light / (4 * std::numbers::pi * static_cast<double>(bands)) + emission.mean(x));
    });
}

std::size_t MediumRadianceCache::index_of(const Vector3& place) const {
    const auto along_axis = [&](int axis) {
        const int count = count_[static_cast<std::size_t>(axis)];
        return static_cast<std::size_t>(std::clamp(static_cast<int>(place[axis]), 0, count - 1));
    };
    return (along_axis(2) * static_cast<std::size_t>(count_[1]) + along_axis(1)) *
               static_cast<std::size_t>(count_[0]) +
           along_axis(0);
}

double MediumRadianceCache::at(const Point3& x) const {
    if (cells_.empty()) return 0;
    const Vector3 place = (x - bounds_.min) / edge_;
    for (int axis = 0; axis < 3; ++axis)
        if (!(place[axis] >= 0 && place[axis] < count_[static_cast<std::size_t>(axis)])) return 0;
    return static_cast<double>(cells_[index_of(place)].light);
}

// Takes a cell's edge at a time, and the cell in the middle of each step.
double MediumRadianceCache::along(const Ray& ray, double max_distance) const {
    if (cells_.empty()) return 0;
    const Interval part = inside(ray, bounds_);
    const double begin = std::max(part.begin, 0.0), end = std::min(part.end, max_distance);
    if (!(end > begin)) return 0;
    const double count = std::ceil((end - begin) / edge_), step = (end - begin) / count;
    Vector3 place = (ray.at(begin + 0.5 * step) - bounds_.min) / edge_;
    const Vector3 stride = step / edge_ * ray.direction;
    double light = 0, transmittance = 1;
    for (double n = 0; n < count && transmittance > k_negligible_transmittance; ++n) {
        const Cell& cell = cells_[index_of(place)];
        // e^-x is approximated by 1 / (1 + x).
        const double passed = 1 / (1 + static_cast<double>(cell.attenuation) * step);
        light += transmittance * static_cast<double>(cell.scattering * cell.light) * step * passed;
        transmittance *= passed;
        place += stride;
    }
    return light;
}

}  // namespace uw
