#include "core/light/planes_integrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/image/image_quantity.h"

namespace uw {

namespace {

constexpr const char* k_uniform_water_only =
    "the planes integrator handles only uniform water: remove `volumes` and `water.profile`, or "
    "use "
    "integrator volume";

void check_for_planes(const SceneDesc& scene) {
    if (!scene.volumes.empty())
        throw InputError(fmt::format("{}: {}", scene.volumes.front().where, k_uniform_water_only));
    if (scene.water.profile)
        throw InputError(fmt::format("{}: {}", scene.water.profile->where, k_uniform_water_only));
    if (scene.camera.distortion.model == DistortionDesc::Model::fisheye)
        throw InputError(fmt::format(
            "{}: render.integrator: the planes integrator sums over slabs parallel to the image "
            "plane, but a fisheye lens can see past them; use integrator volume",
            scene.file.filename().string()));
}

LightTransport make_planes(const IntegratorInputs& inputs) {
    return {
        std::make_unique<PlanesIntegrator>(inputs.scene, inputs.world_from_camera, inputs.slabs),
        std::make_unique<DirectLighting>(inputs.scene)};
}

}  // namespace

constinit const IntegratorKind PlanesIntegrator::k_kind{
    .sums_slabs = true, .check = check_for_planes, .make = make_planes};

struct PlanesIntegrator::Workspace {
    std::vector<Sample> samples;
    std::vector<Spectrum> radiance;  // per sample
    std::vector<Spectrum> evenness;  // of the current lamp, by Sample::distance
    // For the samples that the lamp illuminates:
    std::vector<std::size_t> lit;
    std::vector<double> path;    // lamp to sample to camera [m]
    std::vector<double> weight;  // relative intensity / R^2 * length [1/m]
    std::vector<double> psi;
    std::vector<double> phase;
    std::vector<Spectrum> beta;
    // These are of a part of the sky:
    std::vector<double> mean_phases;
    SkyScattering::Workspace sky;
};

PlanesIntegrator::PlanesIntegrator(const LitScene& scene, const Affine& world_from_camera,
                                   const Slabs& slabs)
    : scene_(scene),
      evenness_(scene),
      sky_(scene),
      camera_from_world_(world_from_camera.inverse()),
      slabs_(slabs),
      attenuation_(*scene.medium) {
    if (scene.medium->constituent_count() > 0) throw InputError(k_uniform_water_only);
}

void PlanesIntegrator::in_scatter(const Ray& ray, std::span<const double> distances,
                                  InScatter& result) const {
    in_scatter_from(ray, 0, distances, result);
}

void PlanesIntegrator::in_scatter_from(const Ray& ray, double begin,
                                       std::span<const double> distances, InScatter& result) const {
    Workspace w;
    const std::vector<Lamp>& emitters = *scene_.emitters;
    result.reset(distances.size(), scene_.lamp_count());
    place_samples(ray, begin, distances, w.samples);
    for (std::size_t j = 0; j < emitters.size(); ++j) {
        throw_if_stopped();
        light_samples(ray, j, w);
        const std::size_t lamp = emitters[j].index();
        if (j == 0 || lamp != emitters[j - 1].index())
            evenness_.find(lamp, ray, begin, distances, w.evenness);
        Spectrum whole;
        std::size_t next = 0;
        const auto finish =
            [&](std::size_t until) {  // all whole slabs before these have been summed
                for (; next < until; ++next) result.at(next, lamp) += whole;
            };
        for (std::size_t i = 0; i < w.samples.size(); ++i) {
            const Sample& sample = w.samples[i];
            if (!sample.cut) finish(sample.distance);
            Spectrum& sum = sample.cut ? result.at(sample.distance, lamp) : whole;
            sum += w.evenness[sample.distance] * w.radiance[i];
        }
        finish(distances.size());
    }
}

void PlanesIntegrator::place_samples(const Ray& ray, double begin,
                                     std::span<const double> distances,
                                     std::vector<Sample>& samples) const {
    samples.clear();
    const RayDepth depth(camera_from_world_, ray);
    if (depth.cosine() <= 0) return;
    std::size_t next = 0;  // the first distance that is not before the slab
    for (int i = 0; i < slabs_.count; ++i) {
        const Interval slab{std::max(begin, depth.distance(slabs_.boundary(i))),
                            depth.distance(slabs_.boundary(i + 1))};
        if (slab.length() <= 0) continue;
        for (; next < distances.size() && distances[next] < slab.end; ++next)
            if (distances[next] > slab.begin)
                samples.push_back({0.5 * (slab.begin + distances[next]),
                                   distances[next] - slab.begin, next, true});
        if (next == distances.size()) return;
        samples.push_back({0.5 * (slab.begin + slab.end), slab.length(), next, false});
    }
}

void PlanesIntegrator::light_samples(const Ray& ray, std::size_t emitter, Workspace& w) const {
    const Lamp& lamp = (*scene_.emitters)[emitter];
    const bool is_sky = sky_.contains(emitter);
    const double lengthening = is_sky ? sky_.find(emitter, ray.direction, w.mean_phases, w.sky) : 1;
    const Medium& medium = *scene_.medium;
    w.radiance.assign(w.samples.size(), Spectrum{});
    w.lit.clear();
    w.path.clear();
    w.weight.clear();
    w.psi.clear();
    const double squared_offset = lamp.squared_offset(ray);
    for (std::size_t i = 0; i < w.samples.size(); ++i) {
        const Sample& sample = w.samples[i];
        const Point3 x = ray.at(sample.s);
        const Point3 origin = lamp.origin(x);
        const Vector3 from_lamp = x - origin;
        const double radius = std::sqrt(glm::dot(from_lamp, from_lamp) + squared_offset);
        const double relative =
            lamp.contains(radius) ? 0.0 : lamp.relative_intensity(from_lamp) * lamp.focus(x);
        if (relative <= 0 || scene_.surfaces->occluded(origin, x)) continue;
        w.lit.push_back(i);
        w.path.push_back(lengthening * radius + sample.s);
        w.weight.push_back(relative / lamp.spread(radius) * sample.length);
        // Angle between the directions of travel, lamp to X and X to camera; atan2 is accurate near
        // pi.
        const Vector3 across = glm::cross(ray.direction, from_lamp);
        w.psi.push_back(std::atan2(std::sqrt(glm::dot(across, across) + squared_offset),
                                   -glm::dot(ray.direction, from_lamp)));
    }
    const auto bands = static_cast<std::size_t>(medium.band_count());
    w.phase.resize(w.psi.size());
    w.beta.assign(w.psi.size(), Spectrum{});
    for (std::size_t m = 0; m < medium.phase_functions.size(); ++m) {
        if (is_sky)
            std::ranges::fill(w.phase, w.mean_phases[m]);
        else
            medium.phase_functions[m]->eval(w.psi, w.phase);
        const Spectrum& scattering = medium.uniform.scattering[m];
        for (std::size_t i = 0; i < w.psi.size(); ++i)
            add_scaled(w.beta[i].first(bands), w.phase[i], scattering.first(bands));
    }
    for (std::size_t i = 0; i < w.lit.size(); ++i)
        w.radiance[w.lit[i]] = per_band(bands, [&](std::size_t b) {
            return lamp.axis_intensity()[b] * w.weight[i] * w.beta[i][b] *
                   std::exp(-attenuation_.uniform[b] * w.path[i]);
        });
}

namespace {

// Number of slices from F to where the weight differs from 1 by less than 1e-3. Equal steps of
// sqrt(F / Z) are small near F, where the weight is steep, and large where it hardly changes.
constexpr int k_slices = 64;

}  // namespace

FocusWeightedIntegrator::FocusWeightedIntegrator(std::unique_ptr<const Integrator> integrator,
                                                 double focal_length)
    : integrator_(std::move(integrator)), focal_length_(focal_length) {
    for (int i = k_slices; i > 0; --i) {
        const double ratio = static_cast<double>(k_slices) / i;
        faces_.push_back(focal_length * ratio * ratio);
    }
}

void FocusWeightedIntegrator::in_scatter(const Ray& ray, std::span<const double> distances,
                                         InScatter& result) const {
    std::vector<double> stops;
    InScatter unweighted;
    find_stops(0, distances, stops);
    integrator_->in_scatter(ray, stops, unweighted);
    weigh(0, stops, unweighted, distances, result);
}

void FocusWeightedIntegrator::in_scatter_from(const Ray& ray, double begin,
                                              std::span<const double> distances,
                                              InScatter& result) const {
    std::vector<double> stops;
    InScatter unweighted;
    find_stops(begin, distances, stops);
    integrator_->in_scatter_from(ray, begin, stops, unweighted);
    weigh(begin, stops, unweighted, distances, result);
}

void FocusWeightedIntegrator::find_stops(double begin, std::span<const double> distances,
                                         std::vector<double>& stops) const {
    stops.assign(distances.begin(), distances.end());
    const auto first = std::upper_bound(faces_.begin(), faces_.end(), begin);
    const auto behind = std::lower_bound(first, faces_.end(), distances.back());
    stops.insert(stops.end(), first, behind);
    std::sort(stops.begin(), stops.end());
}

void FocusWeightedIntegrator::weigh(double begin, std::span<const double> stops,
                                    const InScatter& unweighted, std::span<const double> distances,
                                    InScatter& result) const {
    const std::size_t lamps = unweighted.lamp_count();
    result.reset(distances.size(), lamps);
    for (std::size_t j = 0; j < lamps; ++j) {
        Spectrum sum, before;
        std::size_t next = 0;  // of the distances
        for (std::size_t i = 0; i < stops.size(); ++i) {
            const double from = i == 0 ? begin : stops[i - 1];
            const double weight = focus_factor(0.5 * (from + stops[i]), focal_length_);
            sum += weight * (unweighted.at(i, j) - before);
            before = unweighted.at(i, j);
            for (; next < distances.size() && distances[next] <= stops[i]; ++next)
                result.at(next, j) = sum;
        }
    }
}

}  // namespace uw
