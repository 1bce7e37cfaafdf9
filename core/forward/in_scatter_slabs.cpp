#include "core/forward/in_scatter_slabs.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace uw {

void LampPaths::add_mean(double weight, const Point3& x, WaterPath& path) const {
    thread_local std::vector<double> column;
    column.assign(path.columns.size(), 0.0);
    const double each = weight / static_cast<double>(scene_.lamps->size());
    for (std::size_t j = 0; j < scene_.lamps->size(); ++j) {
        if (!column.empty()) column_(j, x, column);
        path.add(each, distance((*scene_.lamps)[j].position(), x), column);
    }
}

/// Consecutive segments of one ray, split at the slabs' faces and at the pixel's distances.
struct InScatterSlabs::Stretches {
    double begin = 0;               // of the first [m]
    std::vector<double> ends;       // of each [m]
    std::vector<double> visible;    // fraction of the pixel that sees it
    std::vector<std::size_t> slab;  // counted from the first requested
    InScatter light;                // from `begin` to each end
};

InScatterSlabs::InScatterSlabs(const LitScene& scene, const Integrator& integrator,
                               const LampPaths& paths, const Affine& world_from_camera,
                               std::vector<double> faces, bool shells, const SensorModel& sensor)
    : scene_(scene),
      integrator_(integrator),
      paths_(paths),
      camera_from_world_(world_from_camera.inverse()),
      faces_(std::move(faces)),
      shells_(shells),
      attenuation_(*scene.medium),
      sensor_(sensor) {}

void InScatterSlabs::integrate(const Ray& ray, std::span<const double> distances,
                               std::span<const double> weights, std::size_t first, std::size_t last,
                               std::vector<SlabLight>& slabs) const {
    thread_local Stretches stretches;
    slabs.resize(last - first);
    for (SlabLight& slab : slabs) {
        slab.lamps.assign(scene_.lamps->size(), Spectrum{});
        slab.weight = Spectrum{};
        slab.to_lamps.reset(attenuation_.constituents.size());
        slab.to_camera.reset(attenuation_.constituents.size());
    }
    split(ray, distances, weights, first, last, stretches);
    if (stretches.ends.empty()) return;
    integrator_.in_scatter_from(ray, stretches.begin, stretches.ends, stretches.light);
    fill_slabs(ray, stretches, slabs);
}

void InScatterSlabs::split(const Ray& ray, std::span<const double> distances,
                           std::span<const double> weights, std::size_t first, std::size_t last,
                           Stretches& stretches) const {
    stretches.ends.clear();
    stretches.visible.clear();
    stretches.slab.clear();
    const RayDepth depth = shells_ ? RayDepth::from_origin() : RayDepth(camera_from_world_, ray);
    if (depth.cosine() <= 0) return;
    const auto face = [&](std::size_t i) { return std::max(0.0, depth.distance(faces_[i])); };
    stretches.begin = face(first);
    double begin = stretches.begin;
    // The weights sum to less than 1 if some samples' rays miss the water.
    double visible = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::size_t next = 0;  // of the distances
    const auto pass_distances = [&](double s) {
        for (; next < distances.size() && distances[next] <= s; ++next) visible -= weights[next];
    };
    pass_distances(begin);
    for (std::size_t i = first; i < last && next < distances.size(); ++i) {
        const double behind = face(i + 1);
        while (next < distances.size() && begin < behind) {
            const double end = std::min(behind, distances[next]);
            stretches.ends.push_back(end);
            stretches.visible.push_back(visible);
            stretches.slab.push_back(i - first);
            begin = end;
            pass_distances(end);
        }
    }
}

void InScatterSlabs::fill_slabs(const Ray& ray, const Stretches& stretches,
                                std::vector<SlabLight>& slabs) const {
    const std::size_t constituents = attenuation_.constituents.size();
    thread_local WaterPath path, part, lit, seen;
    path.reset(constituents);
    part.reset(constituents);
    path.length = stretches.begin;
    if (constituents > 0) scene_.field->column(ray.origin, ray.at(stretches.begin), path.columns);
    for (std::size_t i = 0; i < stretches.ends.size();) {
        SlabLight& slab = slabs[stretches.slab[i]];
        lit.reset(constituents);
        seen.reset(constituents);
        double light = 0, length = 0;
        for (const std::size_t of = stretches.slab[i];
             i < stretches.ends.size() && stretches.slab[i] == of; ++i) {
            const double begin = path.length;
            part.length = stretches.ends[i] - begin;
            if (constituents > 0)
                scene_.field->column(ray.at(begin), ray.at(stretches.ends[i]), part.columns);
            add_weight(path, part, stretches.visible[i], slab.weight);
            const double gained = add_light(stretches, i, slab.lamps);
            const double visible_length = stretches.visible[i] * part.length;
            light += gained;
            length += visible_length;
            path.add(0.5, part.length, part.columns);  // to the midpoint of the segment
            lit.add(gained, path.length, path.columns);
            seen.add(visible_length, path.length, path.columns);
            path.add(0.5, part.length, part.columns);
            path.length = stretches.ends[i];
        }
        // A dark slab has no centroid of its light; that of its water serves for light from others.
        if (light > 0)
            slab.to_camera.add(1 / light, lit.length, lit.columns);
        else if (length > 0)
            slab.to_camera.add(1 / length, seen.length, seen.columns);
        if (light > 0) paths_.add_mean(1, ray.at(slab.to_camera.length), slab.to_lamps);
    }
}

void InScatterSlabs::add_weight(const WaterPath& path, const WaterPath& part, double visible,
                                Spectrum& weight) const {
    const double end = path.length + part.length;
    const double length = visible * part.length * sensor_.mean_surface_factor(path.length, end);
    weight += per_band(static_cast<std::size_t>(attenuation_.band_count), [&](std::size_t band) {
        const double tau = attenuation_.optical_depth(band, path.length, path.columns);
        const double more = attenuation_.optical_depth(band, part.length, part.columns);
        // Assumes that e^-tau falls exponentially along the segment: exact in uniform water.
        const double mean = more > 0 ? -std::expm1(-more) / more : 1.0;
        return length * std::exp(-tau) * mean;
    });
}

double InScatterSlabs::add_light(const Stretches& stretches, std::size_t i,
                                 std::vector<Spectrum>& lamps) {
    double sum = 0;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        Spectrum gained = stretches.light.at(i, j);
        if (i > 0) gained -= stretches.light.at(i - 1, j);
        // Rounding may make a difference negative; cumulative in-scatter never decreases.
        for (double& value : gained) value = std::max(0.0, value);
        gained *= stretches.visible[i];
        lamps[j] += gained;
        for (const double value : gained) sum += value;
    }
    return sum;
}

}  // namespace uw
