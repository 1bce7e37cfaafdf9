#include "render/meters/light_meter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/geometry/surface_reflection.h"
#include "core/geometry/water_surface.h"
#include "core/paths/glass_passage.h"
#include "core/paths/path_tracer.h"
#include "core/paths/path_walk.h"
#include "core/paths/scattering_tables.h"
#include "render/scene_assembly.h"

namespace uw {

namespace {

constexpr int k_batches = 16;
// Phase functions do not vary below this tangent of half the angle.
constexpr double k_min_half_tangent = 0x1p-22;
// The probability of sampling a direction uniformly.
constexpr double k_uniform_probability = 0.5;
// Radiance in a single direction takes fewer rays than irradiance, by this factor.
constexpr int k_vertical_divisor = 4;
constexpr int k_trial_rays = 256;
constexpr std::uint64_t k_meter_seed = 0x6d65746572;

/// Sums the contributions of paths.
class RadianceSum final : public ContributionSink {
  public:
    explicit RadianceSum(std::size_t bands) : bands_(bands) {}
    void add(const PathContribution& contribution) override {
        for (std::size_t b = 0; b < bands_; ++b) sum_[b] += contribution.radiance[b];
    }
    const Spectrum& sum() const { return sum_; }
    void reset() { sum_ = {}; }

  private:
    std::size_t bands_;
    Spectrum sum_{};
};

/// Direct light of a lamp: its direction, and the irradiance on a plane perpendicular to it.
struct Beam {
    Vector3 towards;  // unit vector to the lamp
    Spectrum irradiance{};
    double weight = 0;  // irradiance without attenuation, summed over bands; rays are sampled in
                        // proportion to it
};

std::vector<Beam> beams_at(const AssembledScene& scene, const Point3& x) {
    const AttenuationTable attenuation(scene.water.medium);
    std::vector<double> columns(attenuation.constituents.size());
    std::vector<Beam> beams;
    for (const Lamp& emitter : scene.emitters) {
        const Point3 origin = emitter.origin(x);
        const Vector3 from_lamp = x - origin;
        const double radius = glm::length(from_lamp);
        if (!(radius > 0) || emitter.contains(radius)) continue;
        const double relative =
            emitter.relative_intensity(from_lamp) * emitter.focus(x) / emitter.spread(radius);
        if (!(relative > 0)) continue;
        Beam beam{-from_lamp / radius};
        for (std::size_t b = 0; b < static_cast<std::size_t>(attenuation.band_count); ++b)
            beam.weight += relative * emitter.axis_intensity()[b];
        if (!scene.surfaces->occluded(origin, x)) {
            scene.field->column(origin, x, columns);
            beam.irradiance = attenuation.transmittance(radius, columns);
            beam.irradiance *= emitter.axis_intensity();
            beam.irradiance *= relative;
        }
        beams.push_back(beam);
    }
    return beams;
}

/// Returns the pdf of rays around a lamp over h = tan(psi / 2), a mixture. One half is constant per
/// octave up to h = 1, as the scattered light of a lamp nearby falls as 1/psi. The other half has
/// the shape of the water's phase functions, as has single scattering around the direction of a
/// sun, however peaked.
HalfTangentDensity density_around_lamps(const ScatteringTables& tables) {
    const double octaves = std::log(1 / k_min_half_tangent);
    std::vector<double> values;
    for (const double h : HalfTangentDensity::nodes()) {
        double value = h > 1 ? 0 : 1 / (octaves * std::max(h, k_min_half_tangent));
        for (std::size_t m = 0; m < tables.phase_count(); ++m)
            value += tables.phase_fractions[m] * tables.directions[m].pdf(h);
        values.push_back(value);
    }
    return HalfTangentDensity(values);
}

/// Samples directions from which light arrives, by a mixture of a uniform pdf and pdfs around
/// beams.
class Directions {
  public:
    /// `around` is density_around_lamps.
    Directions(const std::vector<Beam>& beams, const HalfTangentDensity& around)
        : beams_(beams), around_(around) {
        for (const Beam& beam : beams) total_ += beam.weight;
    }

    /// Samples a direction with three random numbers.
    Vector3 sample(PathRandom& random) const {
        const double choice = random.next(), u = random.next(), azimuth = random.next();
        const double uniform = uniform_probability();
        if (choice < uniform) {
            const double z = 1 - 2 * u, r = std::sqrt(std::max(0.0, 1 - z * z));
            const double v = 2 * std::numbers::pi * azimuth;
            return {r * std::cos(v), r * std::sin(v), z};
        }
        double target = (choice - uniform) / (1 - uniform) * total_;
        std::size_t i = 0;
        while (i + 1 < beams_.size() && target >= beams_[i].weight) target -= beams_[i++].weight;
        return direction_around(beams_[i].towards, around_.sample(u), azimuth);
    }

    /// Returns the pdf of sample() [1/sr].
    double pdf(const Vector3& direction) const {
        const double uniform = uniform_probability();
        double around = 0;
        for (const Beam& beam : beams_) {
            const double h = half_tangent_between(direction, beam.towards);
            around += beam.weight * around_.density(h) / around_.mass() * per_solid_angle(h);
        }
        return uniform / (4 * std::numbers::pi) +
               (total_ > 0 ? (1 - uniform) * around / total_ : 0);
    }

  private:
    double uniform_probability() const { return total_ > 0 ? k_uniform_probability : 1; }

    const std::vector<Beam>& beams_;
    const HalfTangentDensity& around_;
    double total_ = 0;
};

/// Estimates the radiance that arrives along a ray, without that of lamps that the ray meets.
class RadianceEstimate {
  public:
    /// `typical`: an estimate of the mean radiance over directions and bands, for the expected
    /// contribution that guides Russian roulette and splitting. Deep in the water, paths would
    /// otherwise underestimate it, from the little direct light of lamps.
    RadianceEstimate(const AssembledScene& scene, const LightTransport& transport, double typical)
        : scene_(scene),
          transport_(transport),
          typical_(typical),
          attenuation_(scene.water.medium),
          bands_(static_cast<std::size_t>(scene.water.medium.band_count())),
          columns_(attenuation_.constituents.size()) {}

    /// `with_sky`: whether to include the radiance of the sky, for which beams are used otherwise.
    Spectrum operator()(Ray ray, std::uint64_t seed, std::uint32_t index, bool with_sky = false) {
        constexpr int k_max_mirrors = 64;  // a plane surface has one; glass has more
        Spectrum radiance{}, throughput = per_band(bands_, [](std::size_t) { return 1.0; });
        for (int mirrors = 0; mirrors < k_max_mirrors; ++mirrors) {
            SurfaceSample sample{ray, {}, 0, 0};
            const bool has_hit = scene_.surfaces->closest_hit(ray, k_far, sample.hit);
            sum_.reset();
            Spectrum leaving{};
            const bool is_surface = has_hit && !is_specular(sample.hit);
            if (is_surface) find_direct(sample, leaving);
            transport_.paths->begin(ray, has_hit ? &sample.hit : nullptr, leaving.first(bands_),
                                    segment_);
            ExpectedLight& expected = segment_.expected;
            expected.pixel = std::max(expected.pixel, typical_);
            expected.ambient = std::max(expected.ambient, typical_ / k_ambient_beyond);
            const auto stream = [&](std::uint64_t kind) {
                return PathRandom(
                    PathRandom::seed_of(seed, kind, static_cast<std::uint64_t>(mirrors)), index);
            };
            PathRandom single = stream(1), water = stream(2), lit = stream(3), surface = stream(4);
            transport_.paths->trace_single(segment_, single, sum_);
            transport_.paths->trace_water(segment_, water, sum_);
            transport_.paths->trace_lit_surfaces(segment_, lit, sum_);
            transport_.paths->trace_surface(segment_, surface, sum_);
            for (std::size_t b = 0; b < bands_; ++b)
                radiance[b] +=
                    throughput[b] * (sum_.sum()[b] + leaving[b] * segment_.transmittance[b]);
            if (!has_hit || is_surface) break;
            if (sample.hit.glass != 0) {
                PathRandom glass = stream(5);
                Spectrum factor = segment_.transmittance;
                const std::optional<Ray> next =
                    sample_glass_passage(scene_.lit(), ray, sample.hit, throughput, glass, factor);
                if (!next) break;
                throughput *= factor;
                ray = *next;
                continue;
            }
            if (with_sky) {
                const Spectrum sky = scene_.surfaces->material(sample.hit).emission;
                for (std::size_t b = 0; b < bands_; ++b)
                    radiance[b] += throughput[b] * sky[b] * segment_.transmittance[b];
            }
            const WaterSurface& mirror = *scene_.water_surface;
            scene_.field->column(ray.origin, sample.hit.position, columns_);
            throughput *= attenuation_.transmittance(sample.hit.distance, columns_);
            const Vector3 normal = -sample.hit.geometric_normal;
            throughput *= mirror.reflectance_from_water(glm::dot(ray.direction, normal));
            ray = mirror.reflected(ray, {sample.hit.distance, normal});
        }
        return radiance;
    }

  private:
    // Finds the emission of the surface and its direct light, at the surface.
    void find_direct(const SurfaceSample& sample, Spectrum& leaving) {
        transport_.surfaces->evaluate_one(sample, light_);
        const SurfaceReflection reflection(*scene_.surfaces, sample, static_cast<int>(bands_));
        if (reflection.emits()) leaving = reflection.emission();
        Spectrum brdf;
        for (std::size_t j = 0; j < light_.emitter_count(); ++j) {
            if (!light_.visible(0, j)) continue;
            brdf_for(light_.emitters()[j], reflection, sample, brdf);
            for (std::size_t b = 0; b < bands_; ++b)
                leaving[b] += light_.irradiance(0, j, b) * brdf[b];
        }
    }

    const AssembledScene& scene_;
    const LightTransport& transport_;
    double typical_;
    AttenuationTable attenuation_;
    std::size_t bands_;
    std::vector<double> columns_;
    CameraSegment segment_;
    SurfaceLight light_;
    RadianceSum sum_{bands_};
};

double mean_radiance(const AssembledScene& scene, const LightTransport& transport,
                     const Directions& directions, const Point3& x, std::uint64_t trial,
                     double typical) {
    std::array<double, k_batches> sums{};
    const auto bands = static_cast<std::size_t>(scene.water.medium.band_count());
    parallel_for(sums.size(), [&](std::size_t batch) {
        RadianceEstimate estimate(scene, transport, typical);
        for (int i = 0; i < k_trial_rays / k_batches; ++i) {
            const auto index = static_cast<std::uint32_t>(i);
            const std::uint64_t seed = PathRandom::seed_of(k_meter_seed + 1, batch, trial);
            PathRandom random(seed, index);
            const Vector3 towards = directions.sample(random);
            const Spectrum light = estimate({x, towards}, seed + 1, index);
            double sum = 0;
            for (const double band : light.first(bands)) sum += band;
            sums[batch] += sum / static_cast<double>(bands) / directions.pdf(towards);
        }
    });
    double sum = 0;
    for (const double each : sums) sum += each;
    return sum / k_trial_rays / (4 * std::numbers::pi);
}

std::uint64_t seed_at(const Point3& x) {
    return PathRandom::seed_of(
        k_meter_seed,
        PathRandom::seed_of(std::bit_cast<std::uint64_t>(x.x), std::bit_cast<std::uint64_t>(x.y),
                            std::bit_cast<std::uint64_t>(x.z)));
}

/// Estimates the mean radiance over all directions by two trials, the second of which uses the
/// result of the first.
double typical_radiance(const AssembledScene& scene, const LightTransport& transport,
                        const Directions& directions, const Point3& x) {
    double typical = 0;
    for (std::uint64_t trial = 0; trial < 2; ++trial)
        typical = mean_radiance(scene, transport, directions, x, trial, typical);
    return typical;
}

/// Returns the mean of `rays` estimates along one ray; each batch has its own `seed`.
Spectrum mean_along(RadianceEstimate& estimate, const Ray& ray, std::uint64_t seed, int rays) {
    Spectrum mean{};
    for (int i = 0; i < rays; ++i) {
        throw_if_stopped();
        Spectrum light = estimate(ray, seed, static_cast<std::uint32_t>(i), true);
        light /= rays;
        mean += light;
    }
    return mean;
}

/// Returns the mean over the batches, and its standard error from their spread.
MeteredSpectrum over_batches(const std::array<Spectrum, k_batches>& batches) {
    MeteredSpectrum value;
    Spectrum squares{};
    for (Spectrum mean : batches) {
        value.mean += mean;
        mean *= mean;
        squares += mean;
    }
    value.mean /= k_batches;
    for (std::size_t b = 0; b < k_max_bands; ++b)
        value.error[b] =
            std::sqrt(std::max(0.0, squares[b] / k_batches - value.mean[b] * value.mean[b]) /
                      (k_batches - 1));
    return value;
}

/// Returns the plane irradiance of sky and suns on calm water, in the air. A sun's irradiance on a
/// level plane in the water, E_n cos, is 1 - R times that in the air.
Spectrum irradiance_in_air(const AssembledScene& scene) {
    const WaterSurface& surface = *scene.water_surface;
    Spectrum total = scene.sky ? scene.sky->irradiance() : Spectrum{};
    for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
        const Sunlight* sun = scene.lamps[i].sunlight();
        if (sun == nullptr || scene.desc().lamps[i].sky) continue;
        const double cosine = -glm::dot(sun->direction, surface.up());
        const double sine_in_air = surface.n() * std::sqrt(std::max(0.0, 1 - cosine * cosine));
        if (!(cosine > 0) || !(sine_in_air < 1)) continue;
        const double enters =
            1 - surface.reflectance_from_air(std::sqrt(1 - sine_in_air * sine_in_air));
        Spectrum light = scene.lamps[i].axis_intensity();
        light *= cosine / enters;
        total += light;
    }
    return total;
}

constexpr std::array k_readings{&MeterReading::down,          &MeterReading::up,
                                &MeterReading::scalar_down,   &MeterReading::scalar_up,
                                &MeterReading::radiance_down, &MeterReading::radiance_up};

}  // namespace

LightMeter::LightMeter(const AssembledScene& scene)
    : scene_(scene),
      transport_(make_path_transport(scene, scene.scattering)),
      around_lamps_(density_around_lamps(transport_.paths->scattering())) {}

MeterReading LightMeter::read(const Point3& x, const Vector3& up, int rays) const {
    const std::vector<Beam> beams = beams_at(scene_, x);
    const Directions directions(beams, around_lamps_);
    const int in_batch = std::max(1, rays / k_batches);
    const double typical = typical_radiance(scene_, transport_, directions, x);
    const std::uint64_t seed = seed_at(x);
    std::array<MeterReading, k_batches> batches;
    parallel_for(batches.size(), [&](std::size_t batch) {
        RadianceEstimate estimate(scene_, transport_, typical);
        MeterReading& sums = batches[batch];
        for (int i = 0; i < in_batch; ++i) {
            throw_if_stopped();
            const auto index = static_cast<std::uint32_t>(i);
            const auto of = [&](std::uint64_t stream) {
                return PathRandom::seed_of(seed, batch, stream);
            };
            PathRandom random(of(0), index);
            const Vector3 towards = directions.sample(random);
            Spectrum light = estimate({x, towards}, of(1), index);
            const double rise = glm::dot(towards, up);
            light /= directions.pdf(towards) * in_batch;
            // Light from above travels down.
            (rise > 0 ? sums.scalar_down : sums.scalar_up).mean += light;
            light *= std::abs(rise);
            (rise > 0 ? sums.down : sums.up).mean += light;
        }
        const int vertical = std::max(1, in_batch / k_vertical_divisor);
        sums.radiance_down.mean =
            mean_along(estimate, {x, up}, PathRandom::seed_of(seed, batch, 3), vertical);
        sums.radiance_up.mean =
            mean_along(estimate, {x, -up}, PathRandom::seed_of(seed, batch, 2), vertical);
    });
    MeterReading result;
    for (const auto reading : k_readings) {
        std::array<Spectrum, k_batches> means;
        std::ranges::transform(batches, means.begin(),
                               [&](const MeterReading& batch) { return (batch.*reading).mean; });
        result.*reading = over_batches(means);
    }
    for (const Beam& beam : beams) {
        const double rise = glm::dot(beam.towards, up);
        Spectrum light = beam.irradiance;
        (rise > 0 ? result.scalar_down : result.scalar_up).mean += light;
        light *= std::abs(rise);
        (rise > 0 ? result.down : result.up).mean += light;
    }
    return result;
}

std::optional<WaterLeaving> LightMeter::read_water_leaving(const Point3& x, int rays) const {
    constexpr double k_below = 1e-6;  // distance from the surface [m]
    const std::optional<WaterSurface>& surface = scene_.water_surface;
    if (!surface || surface->has_waves()) return std::nullopt;
    const Vector3& up = surface->up();
    const Point3 below = x - (surface->height(x) + k_below) * up;
    WaterLeaving result;
    result.irradiance = irradiance_in_air(scene_);
    const auto bands = static_cast<std::size_t>(scene_.water.medium.band_count());
    if (std::ranges::all_of(result.irradiance.first(bands), [](double e) { return !(e > 0); }))
        return std::nullopt;
    const std::vector<Beam> beams = beams_at(scene_, below);
    const double typical =
        typical_radiance(scene_, transport_, Directions(beams, around_lamps_), below);
    std::array<Spectrum, k_batches> batches;
    parallel_for(batches.size(), [&](std::size_t batch) {
        RadianceEstimate estimate(scene_, transport_, typical);
        batches[batch] =
            mean_along(estimate, {below, -up}, PathRandom::seed_of(seed_at(below), batch, 2),
                       std::max(1, rays / k_batches));
    });
    result.radiance = over_batches(batches);
    const double transmitted =
        (1 - surface->reflectance_from_water(1)) / (surface->n() * surface->n());
    result.radiance.mean *= transmitted;
    result.radiance.error *= transmitted;
    for (std::size_t b = 0; b < bands; ++b) {
        if (!(result.irradiance[b] > 0)) continue;
        result.reflectance.mean[b] = result.radiance.mean[b] / result.irradiance[b];
        result.reflectance.error[b] = result.radiance.error[b] / result.irradiance[b];
    }
    return result;
}

}  // namespace uw
