#include "core/paths/guiding_distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/light/lamp.h"

namespace uw {

namespace {

// Water outside a lamp's beam is still filled with scattered light. If the guide fell to nothing
// there, the few paths that went there would carry far too much light.
constexpr double k_guide_min_relative = 0.3, k_guide_min_cosine = 0.1;
constexpr double k_guide_min_reflectance = 0.1;
constexpr double k_guide_min_radius = 0.002;  // m: keeps the radiance finite at a lamp
constexpr double k_guide_min_depth = 1e-6;
// Near a point lamp, hardly any light has been scattered more than once. Just below a surface that
// a sun illuminates everywhere, as much has as some way down: its place in the table is at least
// this deep. If little were expected there, the few paths that come up from deep water would carry
// far too much light.
constexpr double k_guide_min_depth_of_sun = 2;
// A few bands, evenly spaced, represent all of them.
constexpr std::size_t k_max_guide_bands = 4;

std::size_t band_stride(std::size_t bands) {
    return (bands + k_max_guide_bands - 1) / k_max_guide_bands;
}

double sum_of_guiding_bands(const Spectrum& weights, std::size_t bands) {
    double sum = 0;
    const std::size_t stride = band_stride(bands);
    for (std::size_t b = stride / 2; b < bands; b += stride) sum += weights[b];
    return sum;
}

/// The optical depth and the mean albedo of a path through the water in one band.
struct Depth {
    double tau = 0, albedo = 0;

    Depth(const GuidingTables& tables, std::size_t band, double length,
          std::span<const double> column)
        : tau(tables.optics.attenuation().optical_depth(band, length, column)) {
        if (!(tau > 0)) return;
        double scattered = tables.uniform_scattering[band] * length;
        for (std::size_t k = 0; k < column.size(); ++k)
            scattered += tables.constituents_scattering[k][band] * column[k];
        albedo = scattered / tau;
    }
};

double guided_intensity(const Lamp& lamp, const Vector3& from_lamp) {
    return std::max(k_guide_min_relative, lamp.relative_intensity(from_lamp));
}

/// The optical depth at which the table is looked up.
double guided_depth(const Lamp& lamp, double depth) {
    return std::max(depth, lamp.sunlight() ? k_guide_min_depth_of_sun : k_guide_min_depth);
}

double guided_spread(const GuidingTables& tables, const Lamp& lamp, double distance) {
    return tables.spread(lamp, std::max(distance, k_guide_min_radius));
}

}  // namespace

GuidingTables::GuidingTables(const WaterOptics& of_optics, const ScatteringTables& of_scattering,
                             const NextEventEstimator& of_lamps, const EmissionSampler& of_emission)
    : optics(of_optics),
      scattering(of_scattering),
      lamps(of_lamps),
      lamp_radiance(of_scattering.lamp_radiance()),
      emission(of_emission),
      particles(of_optics, lamp_radiance, of_lamps, of_emission) {
    const auto sum = [](const OpticalCoefficients& coefficients) {
        Spectrum all;
        for (const Spectrum& b : coefficients.scattering) all += b;
        return all;
    };
    uniform_scattering = sum(optics.scene().medium->uniform);
    for (const Constituent& constituent : optics.scene().medium->constituents)
        constituents_scattering.push_back(sum(constituent.per_unit));
}

Point3 GuidingTables::origin(const Lamp& lamp, const Point3& x) const {
    return lamp.is_met_by_paths() && !lamp.is_mirrored() ? emission.sphere(lamp.index()).centre
                                                         : lamp.origin(x);
}

double GuidingTables::spread(const Lamp& lamp, double radius) const {
    return lamp.spread(radius) +
           (lamp.is_met_by_paths() ? emission.sphere(lamp.index()).square : 0);
}

void GuidingTables::column(std::size_t lamp, const Point3& x, std::span<double> column) const {
    if ((*optics.scene().emitters)[lamp].is_met_by_paths())
        std::ranges::fill(column, 0.0);
    else
        lamps.column_to_lamp(lamp, x, column);
}

double GuidingTables::fraction(const Lamp& lamp) const {
    return lamp.is_met_by_paths() ? emission.sphere(lamp.index()).escaping : 1;
}

void GuidingDistribution::find(const GuidingTables& tables, const Point3& x,
                               const Spectrum& weights) {
    tables_ = &tables;
    guides_.clear();
    cumulative_.clear();
    const WaterOptics& optics = tables.optics;
    const LampRadianceTable& field = tables.lamp_radiance;
    const std::vector<Lamp>& lamps = *optics.scene().emitters;
    const std::size_t bands = optics.bands(), stride = band_stride(bands);
    const double all = sum_of_guiding_bands(weights, bands);
    if (!(all > 0)) return;
    column_.resize(optics.constituents());
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        const Vector3 to_lamp = tables.origin(lamps[j], x) - x;
        const double length = glm::length(to_lamp);
        if (!(length > 0)) continue;
        tables.column(j, x, column_);
        const double fraction = tables.fraction(lamps[j]);
        double sum = 0, tau = 0, albedo = 0, scattered_once = 0, emitted = 0;
        for (std::size_t b = stride / 2; b < bands; b += stride) {
            const Depth depth(tables, b, length, column_);
            const double intensity = fraction * lamps[j].axis_intensity()[b];
            const double weight =
                weights[b] / all * intensity * field.flux(field.at(depth.tau, depth.albedo));
            sum += weight;
            tau += weight * depth.tau;
            albedo += weight * depth.albedo;
            if (lamps[j].is_met_by_paths()) emitted += weights[b] / all * intensity;
            if (lamps[j].sunlight())
                scattered_once += weights[b] / all * lamps[j].axis_intensity()[b] *
                                  std::exp(-depth.tau) * depth.tau * depth.albedo;
        }
        if (!(sum > 0)) continue;
        Guide& guide = guides_.emplace_back();
        guide.lamp = j;
        guide.direction = to_lamp / length;
        guide.radius = length;
        guide.albedo = albedo / sum;
        const double depth = std::max(tau / sum, k_guide_min_depth);
        guide.attenuation = depth / length;
        guide.place = field.at(guided_depth(lamps[j], depth), guide.albedo);
        guide.intensity = sum / field.flux(guide.place);
        const double geometry =
            guided_intensity(lamps[j], -to_lamp) / guided_spread(tables, lamps[j], length);
        guide.irradiance = sum * geometry;
        cumulative_.push_back((cumulative_.empty() ? 0 : cumulative_.back()) + guide.irradiance);
        guide.scattered_once = scattered_once;
        guide.emitted = emitted;
        guide.scale = guide.intensity * guide.place.radius * guide.place.radius * geometry;
    }
}

// A guide has the lobe of its lamp; a sun has two, of which one is for its light that is scattered
// once.
Vector3 GuidingDistribution::sample(double u, double azimuth) const {
    const Guide& guide = guides_[choose(cumulative_, u).index];
    const HalfTangentDensity* lobe = &tables_->lamp_radiance.lobe(guide.place);
    if (guide.scattered_once > 0) {
        u *= 2;
        if (u >= 1) {
            u -= 1;
            lobe = &tables_->lamp_radiance.phase();
        }
    }
    return direction_around(guide.direction, lobe->sample(u), azimuth);
}

GuidingDistribution::Towards GuidingDistribution::towards(const Vector3& direction) const {
    if (guides_.empty()) return {};
    const LampRadianceTable& field = tables_->lamp_radiance;
    Towards light;
    for (const Guide& guide : guides_) {
        const double h = half_tangent_between(guide.direction, direction);
        const double per_h = per_solid_angle(h);
        light.radiance += guide.scale * field.radiance(guide.place, h);
        double pdf = field.lobe(guide.place).pdf(h);
        if (guide.scattered_once > 0) {
            const double once = field.phase().pdf(h);
            light.radiance += guide.scattered_once * once * per_h;
            pdf = 0.5 * (pdf + once);
        }
        light.pdf += guide.irradiance * pdf * per_h;
    }
    light.pdf /= cumulative_.back();
    return light;
}

double GuidingDistribution::multiple(const Vector3& direction) const {
    const LampRadianceTable& field = tables_->lamp_radiance;
    double light = 0;
    for (const Guide& guide : guides_) {
        const double h = half_tangent_between(guide.direction, direction);
        light += guide.scale * (guide.emitted > 0 ? field.radiance(guide.place, h)
                                                  : field.multiple(guide.place, h));
    }
    return light;
}

double GuidingDistribution::source(const Point3& y, const Vector3& direction) const {
    const LampRadianceTable& field = tables_->lamp_radiance;
    double light = 0;
    for (const Guide& guide : guides_) {
        const Lamp& lamp = (*tables_->optics.scene().emitters)[guide.lamp];
        const Vector3 to_lamp = tables_->origin(lamp, y) - y;
        const double length = std::max(glm::length(to_lamp), 1e-9);
        const double h = half_tangent_between(to_lamp / length, direction);
        const double spread = guided_spread(*tables_, lamp, length);
        const LampRadianceTable::Place place =
            field.at(guided_depth(lamp, length * guide.attenuation), guide.albedo);
        light += guide.intensity * guided_intensity(lamp, -to_lamp) * place.radius * place.radius /
                 spread * field.source(place, h);
        if (guide.emitted > 0)
            light += guide.emitted * std::exp(-length * guide.attenuation) / spread *
                     field.phase().pdf(h) * per_solid_angle(h);
    }
    return light;
}

double estimated_reflection(const GuidingTables& tables, const SurfaceHit& hit,
                            const Spectrum& weights, std::vector<double>& column) {
    const WaterOptics& optics = tables.optics;
    const LampRadianceTable& field = tables.lamp_radiance;
    column.resize(optics.constituents());
    const std::size_t bands = optics.bands(), stride = band_stride(bands);
    const double all = sum_of_guiding_bands(weights, bands);
    if (!(all > 0)) return 0;
    double light = 0;
    const std::vector<Lamp>& lamps = *optics.scene().emitters;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        const Vector3 to_lamp = tables.origin(lamps[j], hit.position) - hit.position;
        const double length = std::max(glm::length(to_lamp), k_guide_min_radius);
        tables.column(j, hit.position, column);
        const double geometry =
            tables.fraction(lamps[j]) * guided_intensity(lamps[j], -to_lamp) *
            std::max(k_guide_min_cosine, glm::dot(hit.normal, to_lamp) / length) /
            tables.spread(lamps[j], length) * std::numbers::inv_pi;
        for (std::size_t b = stride / 2; b < bands; b += stride) {
            const Depth depth(tables, b, length, column);
            light += weights[b] / all * geometry * lamps[j].axis_intensity()[b] *
                     std::max(k_guide_min_reflectance, hit.reflectance[b]) *
                     field.flux(field.at(depth.tau, depth.albedo));
        }
    }
    return light;
}

}  // namespace uw
