#include "render/snow/snow_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"

namespace uw {

namespace {

// Below this x, expm1(x) / x is 1.
constexpr double k_min_power = 1e-12;

/// Returns int_a^b D^power dD, without cancellation where the power is close to -1.
double integral_of_power(double power, double a, double b) {
    const double x = (power + 1) * std::log(b / a);
    const double ratio = std::abs(x) < k_min_power ? 1 : std::expm1(x) / x;
    return std::pow(a, power + 1) * std::log(b / a) * ratio;
}

}  // namespace

JungeSizes::JungeSizes(double exponent, double least, double greatest)
    : exponent_(exponent), least_(least), greatest_(greatest) {}

double JungeSizes::fraction(double a, double b) const {
    return integral_of_power(-exponent_, a, b) / integral_of_power(-exponent_, least_, greatest_);
}

double JungeSizes::quantile(double u, double a, double b) const {
    const double power = 1 - exponent_, x = power * std::log(b / a);
    if (std::abs(x) < k_min_power) return a * std::pow(b / a, u);
    return a * std::exp(std::log1p(u * std::expm1(x)) / power);
}

double JungeSizes::mean_area(double a, double b) const {
    return std::numbers::pi / 4 * integral_of_power(2 - exponent_, a, b) /
           integral_of_power(-exponent_, a, b);
}

namespace {

constexpr std::uint64_t k_stream = 0x736e6f77;  // differs from the seeds of light paths
// Mean number of particles in a cell: so many that the cost of a cell itself is negligible, and so
// few that cells fit a view closely.
constexpr double k_per_cell = 16;
// Minimum ratio of the diameters of the last octave, which is joined to the one before if it is
// narrower.
constexpr double k_min_ratio = 1.01;

}  // namespace

SnowField::SnowField(const SnowDesc& desc)
    : sizes_(desc.exponent, desc.least, desc.greatest), drift_(desc.drift), seed_(desc.seed) {
    for (double least = desc.least; least < desc.greatest;) {
        double greatest = 2 * least;
        if (greatest * k_min_ratio > desc.greatest) greatest = desc.greatest;
        const double number = desc.number * sizes_.fraction(least, greatest);
        classes_.push_back({.least = least,
                            .greatest = greatest,
                            .number = number,
                            .mean_area = sizes_.mean_area(least, greatest),
                            .edge = std::cbrt(k_per_cell / number)});
        least = greatest;
    }
}

void SnowField::append_particles(std::size_t index, const SnowCell& cell, double time,
                                 std::vector<SnowParticle>& particles) const {
    const SnowClass& size_class = classes_[index];
    std::uint64_t seed = PathRandom::seed_of(k_stream, seed_, index);
    for (const std::int64_t i : cell)
        seed = PathRandom::seed_of(seed, static_cast<std::uint64_t>(i));
    PathRandom of_cell(seed, 0);
    const auto count = static_cast<std::uint64_t>(poisson(k_per_cell, of_cell));
    const Vector3 moved = displacement(time);
    for (std::uint64_t n = 0; n < count; ++n) {
        const std::uint64_t id = PathRandom::seed_of(seed, n + 1);
        PathRandom random(id, 0);
        SnowParticle& particle = particles.emplace_back();
        for (int axis = 0; axis < 3; ++axis)
            particle.position[axis] =
                (static_cast<double>(cell[static_cast<std::size_t>(axis)]) + random.next()) *
                    size_class.edge +
                moved[axis];
        particle.diameter = sizes_.quantile(random.next(), size_class.least, size_class.greatest);
        particle.id = id;
    }
}

namespace {

/// Increases the scattering of the uniform water by `b`, with the phase function of diffuse
/// spheres, at constant attenuation. What is added and then subtracted leaves nothing, as both have
/// the same phase function.
void scatter_more(const Spectrum& b, Medium& medium) {
    auto& phases = medium.phase_functions;
    const auto known = std::ranges::find_if(phases, [](const auto& phase) {
        return dynamic_cast<const LambertSphere*>(phase.get()) != nullptr;
    });
    const auto m = static_cast<std::size_t>(known - phases.begin());
    if (m == phases.size()) {
        phases.push_back(std::make_shared<LambertSphere>());
        medium.uniform.scattering.emplace_back();
        for (Constituent& constituent : medium.constituents)
            constituent.per_unit.scattering.emplace_back();
    }
    medium.uniform.scattering[m] += b;
    medium.uniform.absorption -= b;
}

/// Turns the scattering of `x` into absorption.
void stop_scattering(OpticalCoefficients& x) {
    x.absorption = x.attenuation();
    for (Spectrum& b : x.scattering) b = {};
}

void check_rest(const SnowDesc& snow, const Medium& water, const Spectrum& b) {
    constexpr int k_steps = 360;
    // Tolerance for rounding, as the coefficients may have been added and subtracted.
    constexpr double k_rounding = 1e-9;
    for (int i = 0; i <= k_steps; ++i) {
        const double psi = std::numbers::pi * i / k_steps;
        Spectrum beta;
        for (std::size_t m = 0; m < water.phase_functions.size(); ++m)
            beta += water.uniform.scattering[m] * water.phase_functions[m]->eval(psi);
        for (std::size_t band = 0; band < water.wavelengths_nm.size(); ++band) {
            const double own = b[band] * LambertSphere::at(psi);
            if (own <= beta[band] * (1 + k_rounding)) continue;
            throw InputError(fmt::format(
                "{}: the particles scatter {:.3g} 1/(m sr) at {:g} nm by {:.0f} degrees, more than "
                "the water's coefficients hold ({:.3g}); give fewer, smaller or darker ones, or "
                "write mean: added",
                snow.where, own, water.wavelengths_nm[band], 180.0 * i / k_steps, beta[band]));
        }
    }
}

}  // namespace

SnowCoefficients snow_coefficients(const SnowDesc& snow) {
    const JungeSizes sizes(snow.exponent, snow.least, snow.greatest);
    SnowCoefficients result;
    result.attenuation = snow.number * sizes.mean_area(snow.least, snow.greatest);
    for (std::size_t b = 0; b < snow.reflectance.size(); ++b)
        result.scattering[b] = result.attenuation * snow.reflectance[b];
    return result;
}

void add_snow(const SnowDesc& snow, Medium& medium) {
    const SnowCoefficients own = snow_coefficients(snow);
    scatter_more(own.scattering, medium);
    for (double& a : medium.uniform.absorption.first(medium.wavelengths_nm.size()))
        a += own.attenuation;
}

Medium without_snow(const SnowDesc& snow, const Medium& medium) {
    const Spectrum b = snow_coefficients(snow).scattering;
    check_rest(snow, medium, b);
    Medium rest = medium;
    scatter_more(-1.0 * b, rest);
    return rest;
}

Medium snow_alone(const SnowDesc& snow, const Medium& medium) {
    Medium alone = medium;
    stop_scattering(alone.uniform);
    for (Constituent& constituent : alone.constituents) stop_scattering(constituent.per_unit);
    scatter_more(snow_coefficients(snow).scattering, alone);
    return alone;
}

BeyondSnow::BeyondSnow(std::unique_ptr<const Integrator> water,
                       std::unique_ptr<const Integrator> snow, std::vector<Part> parts)
    : water_(std::move(water)), snow_(std::move(snow)), parts_(std::move(parts)) {
    std::ranges::sort(parts_, {}, &Part::range);
}

void BeyondSnow::in_scatter(const Ray& ray, std::span<const double> distances,
                            InScatter& result) const {
    water_->in_scatter(ray, distances, result);
    add_beyond(ray, 0, distances, result);
}

void BeyondSnow::in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                                 InScatter& result) const {
    water_->in_scatter_from(ray, begin, distances, result);
    add_beyond(ray, begin, distances, result);
}

void BeyondSnow::add_beyond(const Ray& ray, double begin, std::span<const double> distances,
                            InScatter& result) const {
    const double from = std::max(begin, parts_.front().range);
    const double end = distances.back();
    if (!(end > from)) return;
    std::vector<double> stops;
    stops.reserve(distances.size() + parts_.size());
    for (const double distance : distances)
        if (distance > from) stops.push_back(distance);
    for (const Part& part : parts_)
        if (part.range > from && part.range < end) stops.push_back(part.range);
    std::ranges::sort(stops);
    InScatter light;
    snow_->in_scatter_from(ray, from, stops, light);
    const auto up_to = [&](double distance, std::size_t lamp) {
        if (!(distance > from)) return Spectrum{};
        const auto stop = std::ranges::lower_bound(stops, distance);
        return light.at(static_cast<std::size_t>(stop - stops.begin()), lamp);
    };
    for (std::size_t i = 0; i < distances.size(); ++i)
        for (std::size_t lamp = 0; lamp < result.lamp_count(); ++lamp)
            for (const Part& part : parts_) {
                if (part.range >= distances[i]) continue;
                Spectrum beyond = up_to(distances[i], lamp) - up_to(part.range, lamp);
                // With few slabs, the light up to the range may exceed that up to the distance.
                for (double& radiance : beyond.values) radiance = std::max(radiance, 0.0);
                result.at(i, lamp) += part.fraction * beyond;
            }
}

double SnowModel::drawn_depth(double distance) const {
    double depth = 0;
    for (std::size_t k = 0; k < ranges.size(); ++k)
        depth += field.classes()[k].attenuation() * std::min(distance, ranges[k]);
    return depth;
}

std::vector<BeyondSnow::Part> SnowModel::parts() const {
    double all = 0;
    for (const SnowClass& size_class : field.classes()) all += size_class.attenuation();
    std::vector<BeyondSnow::Part> parts;
    for (std::size_t k = 0; k < ranges.size(); ++k)
        parts.push_back({ranges[k], field.classes()[k].attenuation() / all});
    return parts;
}

namespace {

// Particles are drawn if they cover this fraction of a pixel, unless there are too many.
constexpr double k_min_coverage = 1e-3;
// Fraction of a pixel above which the eye would miss single particles that are not drawn.
constexpr double k_visible_coverage = 0.02;
// Optical depth, in the clearest band, behind which a thousandth of the light is left.
constexpr double k_max_drawn_depth = 6.9;
constexpr double k_max_drawn_distance = 200;  // m
// Ratio of successive coverages that are tried.
constexpr double k_coverage_step = 1.05;

/// Returns the solid angle in water of the whole image [sr].
double view_angle(const Camera& camera) {
    constexpr int k_steps = 32;
    const auto ray = [&](int i, int j) {
        return camera.refracted_ray(static_cast<double>(i) / k_steps * camera.width(),
                                    static_cast<double>(j) / k_steps * camera.height());
    };
    double sum = 0;
    for (int j = 0; j < k_steps; ++j)
        for (int i = 0; i < k_steps; ++i) {
            const auto a = ray(i, j), b = ray(i + 1, j), c = ray(i, j + 1);
            if (a && b && c)
                sum += glm::length(
                    glm::cross(b->direction - a->direction, c->direction - a->direction));
        }
    return sum;
}

}  // namespace

std::shared_ptr<const SnowModel> make_snow_model(const SnowDesc& desc, const Camera& camera,
                                                 const Medium& medium) {
    auto model = std::make_shared<SnowModel>(SnowModel{.field = SnowField(desc),
                                                       .water = without_snow(desc, medium),
                                                       .alone = snow_alone(desc, medium)});
    const std::vector<SnowClass>& classes = model->field.classes();
    const double min_c = medium.uniform.attenuation().least(medium.wavelengths_nm.size());
    const double max_distance =
        std::min(k_max_drawn_distance, k_max_drawn_depth / std::max(min_c, 1e-6));
    const double view = view_angle(camera);
    const double pixel = view / camera.width() / camera.height();
    model->ranges.assign(classes.size(), max_distance);
    double wanted = 0;  // expected number of particles in view
    for (double coverage = k_min_coverage; view > 0; coverage *= k_coverage_step) {
        double count = 0;
        for (std::size_t k = 0; k < classes.size(); ++k) {
            double& range = model->ranges[k];
            range = std::min(max_distance, std::sqrt(classes[k].mean_area / (coverage * pixel)));
            count += classes[k].number * view * range * range * range / 3;
        }
        model->expected_count = count;
        if (wanted == 0) wanted = count;
        if (count > desc.most) continue;
        if (coverage > k_visible_coverage)
            model->warning = fmt::format(
                "{}: of about {:.3g} particles in view {:.3g} are drawn, those that cover {:.2g} % "
                "of a pixel or more, and the others are their mean; give a greater least diameter "
                "or a smaller number, or most",
                desc.where, wanted, count, 100 * coverage);
        break;
    }
    return model;
}

}  // namespace uw
