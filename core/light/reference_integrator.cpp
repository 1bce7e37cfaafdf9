#include "core/light/reference_integrator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "core/base/error.h"
#include "core/light/ray_panels.h"
#include "core/light/surface_lighting.h"

namespace uw {

namespace {

// Light whose path exceeds the least optical depth by this much adds less than 1e-6.
constexpr double k_extinct_optical_depth = 15;
// Steps among particles are a tenth of an optical depth: this many times the step that is given.
constexpr double k_depth_of_steps = 20;
// Water behind this optical depth adds less than 1e-17 of all light.
constexpr double k_dark = 40;

LightTransport make_reference(const IntegratorInputs& inputs) {
    return {std::make_unique<ReferenceIntegrator>(inputs.scene),
            std::make_unique<DirectLighting>(inputs.scene)};
}

}  // namespace

constinit const IntegratorKind ReferenceIntegrator::k_kind{.make = make_reference};

ReferenceIntegrator::ReferenceIntegrator(const LitScene& scene, double step)
    : scene_(scene), evenness_(scene), sky_(scene), attenuation_(*scene.medium), step_(step) {}

void ReferenceIntegrator::in_scatter(const Ray& ray, std::span<const double> distances,
                                     InScatter& result) const {
    const std::vector<Lamp>& emitters = *scene_.emitters;
    result.reset(distances.size(), scene_.lamp_count());
    const Interval grid = inside(ray, scene_.field->grids().bounds());
    const double voxel = scene_.field->finest_voxel();
    const std::shared_ptr<const Strata> strata = scene_.field->strata();
    std::vector<double> bends;  // of the strata
    if (strata) strata->append_breaks(ray, distances.back(), bends);
    const double min_c =
        attenuation_.uniform.least(static_cast<std::size_t>(attenuation_.band_count));
    const double max_c =
        attenuation_.uniform.greatest(static_cast<std::size_t>(attenuation_.band_count));
    SkyScattering::Workspace workspace;
    for (std::size_t j = 0; j < emitters.size(); ++j) {
        const LampPassage passage = emitters[j].passage(ray);
        std::optional<SkyLight> sky;
        if (sky_.contains(j)) {
            sky.emplace();
            sky->lengthening = sky_.find(j, ray.direction, sky->phase, workspace);
        }
        const double max_distance =
            min_c > 0 ? passage.max_distance(k_extinct_optical_depth / min_c) : k_far;
        const auto scale_at = [&](double s) {
            // Beyond ten attenuation lengths of the densest band only the other bands matter, whose
            // light varies over lengths proportional to the distance.
            if (passage.parallel)
                return max_c > 0 ? std::max(1 / max_c, 0.1 * s) / (1 + passage.rate()) : k_far;
            return std::max(passage.radius(s), k_lamp_radius);
        };
        // The water's surface may be less than a step away.
        const Interval lit =
            passage.parallel ? emitters[j].beam(ray, {0, max_distance}) : Interval{0, max_distance};
        Spectrum sum;
        double s = lit.begin;
        double depth = 0;  // of the grid before s, in the band with the least attenuation
        for (std::size_t i = 0; i < distances.size(); ++i) {
            const double end = std::min(distances[i], lit.end);
            const Spectrum even = evenness_.of(emitters[j].index(), ray,
                                               {i == 0 ? 0 : distances[i - 1], distances[i]});
            while (s < end && depth < k_dark) {
                throw_if_stopped();
                double length = step_ * scale_at(s);
                const bool in_grid = s < grid.end && s + length > grid.begin;
                const auto [least, greatest] =
                    in_grid || strata ? attenuation_at(ray.at(s)) : std::pair(0.0, 0.0);
                if (in_grid || strata)
                    length = std::min(length, k_depth_of_steps * step_ / greatest);
                if (in_grid) length = std::min(length, 0.25 * voxel);
                if (const auto bend = std::ranges::upper_bound(bends, s); bend != bends.end())
                    length = std::min(length, *bend - s);
                length = std::min(length, end - s);
                depth += length * least;
                sum += length * even *
                       in_scatter_per_metre(ray, s + 0.5 * length, j, sky ? &*sky : nullptr);
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

Spectrum ReferenceIntegrator::in_scatter_per_metre(const Ray& ray, double s, std::size_t emitter,
                                                   const SkyLight* sky) const {
    const Lamp& lamp = (*scene_.emitters)[emitter];
    const Medium& medium = *scene_.medium;
    const Point3 x = ray.at(s);
    const Point3 origin = lamp.origin(x);
    const Vector3 from_lamp = x - origin;
    const double squared_offset = lamp.squared_offset(ray);
    const double radius = std::sqrt(glm::dot(from_lamp, from_lamp) + squared_offset);
    const double relative = lamp.relative_intensity(from_lamp) * lamp.focus(x);
    if (lamp.contains(radius) || relative <= 0 || scene_.surfaces->occluded(origin, x)) return {};
    // psi is the angle between the directions of travel: w_in = from_lamp, w_out = -ray.direction.
    const Vector3 across = glm::cross(from_lamp, ray.direction);
    const double psi = std::atan2(std::sqrt(glm::dot(across, across) + squared_offset),
                                  -glm::dot(from_lamp, ray.direction));
    const std::size_t constituents = medium.constituents.size();
    std::vector<double> from_lamp_column(constituents), to_camera_column(constituents),
        concentration(constituents);
    scene_.field->column(origin, x, from_lamp_column);
    scene_.field->column(ray.origin, x, to_camera_column);
    scene_.field->sample(x, concentration);
    const double lengthening = sky ? sky->lengthening : 1;
    for (std::size_t k = 0; k < constituents; ++k)
        from_lamp_column[k] = lengthening * from_lamp_column[k] + to_camera_column[k];
    const Spectrum transmittance =
        attenuation_.transmittance(lengthening * radius + s, from_lamp_column);
    Spectrum result;
    for (std::size_t m = 0; m < medium.phase_functions.size(); ++m) {
        const double p = sky ? sky->phase[m] : medium.phase_functions[m]->eval(psi);
        Spectrum b = medium.uniform.scattering[m];
        for (std::size_t k = 0; k < constituents; ++k)
            b += concentration[k] * medium.constituents[k].per_unit.scattering[m];
        result += lamp.axis_intensity() * relative * transmittance * b * p / lamp.spread(radius);
    }
    return result;
}

namespace {

// Initial panels of the quadrature: narrower than a phase function's forward peak where it matters,
// and than the shadows of thin things, so that no feature is missed between the first nodes.
constexpr std::size_t k_first_panels = 500;
constexpr double k_min_rate = 1e-3;    // of -e^(-c s) [1/m]
constexpr int k_deepest_halving = 18;  // 2^-18 of a first panel at a shadow's edge

// Simpson's rule; `sixth` of the panel's width.
Spectrum simpson(const Spectrum& begin, const Spectrum& middle, const Spectrum& end, double sixth) {
    return sixth * (begin + 4 * middle + end);
}

void check_uniform(const LitScene& scene) {
    if (scene.medium->constituent_count() > 0)
        throw std::invalid_argument("the quadrature integrator is for uniform water");
}

}  // namespace

/// The integral of one lamp's light along one ray over the angle psi. For a sun, whose angle is the
/// same all along the ray, it is over -e^(-c s) with the least c of the bands, in which its
/// attenuation is nearly linear.
class QuadratureIntegrator::RayIntegral {
  public:
    RayIntegral(const QuadratureIntegrator& owner, const Ray& ray, std::size_t emitter)
        : owner_(owner),
          ray_(ray),
          lamp_((*owner.scene_.emitters)[emitter]),
          passage_(lamp_.passage(ray)) {
        if (owner.sky_.contains(emitter)) {
            SkyScattering::Workspace workspace;
            const double lengthening =
                owner.sky_.find(emitter, ray.direction, sky_phase_, workspace);
            passage_.begin_length *= lengthening;
            passage_.slope *= lengthening;
        }
        const auto bands = static_cast<std::size_t>(owner.attenuation_.band_count);
        rate_ = std::max(owner.attenuation_.uniform.least(bands), k_min_rate);
        // A ray straight through the lamp has no angle to integrate over, but one that narrowly
        // misses it does.
        passage_.distance = std::max(1e-9, passage_.distance);
    }

    /// In-scatter from `begin` to `end` along the ray.
    Spectrum operator()(double begin, double end) {
        const double from = variable(begin), to = variable(end);
        std::vector<Spectrum> f(2 * k_first_panels + 1);
        for (std::size_t i = 0; i < f.size(); ++i)
            f[i] = integrand(from + (to - from) * static_cast<double>(i) / (2 * k_first_panels));
        const double h = (to - from) / k_first_panels;
        std::vector<Spectrum> coarse(k_first_panels);
        scale_ = Spectrum{};
        for (std::size_t p = 0; p < k_first_panels; ++p) {
            coarse[p] = simpson(f[2 * p], f[2 * p + 1], f[2 * p + 2], h / 6);
            scale_ += coarse[p];
        }
        Spectrum sum;
        for (std::size_t p = 0; p < k_first_panels; ++p) {
            const double a = from + h * static_cast<double>(p);
            sum += refine(a, a + h, f[2 * p], f[2 * p + 1], f[2 * p + 2], coarse[p], 0);
        }
        return sum;
    }

  private:
    // The variable of integration.
    double variable(double s) const {
        return passage_.parallel ? -std::exp(-rate_ * s)
                                 : std::atan2(passage_.distance, passage_.foot - s);
    }

    Spectrum integrand(double variable) const {
        const double distance = passage_.distance, foot = passage_.foot;
        if (!passage_.parallel)
            return scattered(variable, foot - distance / std::tan(variable),
                             foot + distance * std::tan(0.5 * variable), 1 / distance);
        if (!(variable < 0)) return {};
        const double s = -std::log(-variable) / rate_;
        return scattered(2 * std::atan(passage_.tangent), s, s + passage_.radius(s),
                         -1 / (rate_ * variable));
    }

    // The light scattered at `s` by `psi`, attenuated over the `path` from the lamp to the camera.
    Spectrum scattered(double psi, double s, double path, double weight) const {
        const Point3 x = ray_.at(s), origin = lamp_.origin(x);
        const double relative = lamp_.relative_intensity(x - origin) * lamp_.focus(x);
        Spectrum value{};
        if (relative <= 0 || owner_.scene_.surfaces->occluded(origin, x)) return value;
        const Medium& medium = *owner_.scene_.medium;
        for (std::size_t m = 0; m < medium.phase_functions.size(); ++m) {
            const double p =
                sky_phase_.empty() ? medium.phase_functions[m]->eval(psi) : sky_phase_[m];
            value += medium.uniform.scattering[m] * p;
        }
        value *= per_band(static_cast<std::size_t>(medium.band_count()), [&](std::size_t b) {
            return lamp_.axis_intensity()[b] * relative * weight *
                   std::exp(-owner_.attenuation_.uniform[b] * path);
        });
        return value;
    }

    Spectrum refine(double a, double b, const Spectrum& fa, const Spectrum& fm, const Spectrum& fb,
                    const Spectrum& whole, int depth) {
        const double middle = 0.5 * (a + b);
        const Spectrum fl = integrand(0.5 * (a + middle)), fr = integrand(0.5 * (middle + b));
        const Spectrum left = simpson(fa, fl, fm, (middle - a) / 6);
        const Spectrum right = simpson(fm, fr, fb, (b - middle) / 6);
        const Spectrum change = left + right - whole;
        if (depth >= k_deepest_halving || is_small(change, depth))
            return left + right + change / 15;
        return refine(a, middle, fa, fl, fm, left, depth + 1) +
               refine(middle, b, fm, fr, fb, right, depth + 1);
    }

    bool is_small(const Spectrum& change, int depth) const {
        for (std::size_t i = 0; i < k_max_bands; ++i) {
            // The tolerance is divided evenly among the panels that there would be at this depth.
            if (!(std::abs(change[i]) <=
                  15 * owner_.tolerance_ * scale_[i] / (k_first_panels * std::exp2(0.5 * depth))))
                return false;
        }
        return true;
    }

    const QuadratureIntegrator& owner_;
    const Ray& ray_;
    const Lamp& lamp_;
    LampPassage passage_;
    std::vector<double> sky_phase_;  // SkyScattering::find; empty: not of the sky
    double rate_ = 0;                // of a sun
    Spectrum scale_{};               // a first estimate of the integral, per band
};

QuadratureIntegrator::QuadratureIntegrator(const LitScene& scene, double tolerance)
    : scene_(scene),
      evenness_(scene),
      sky_(scene),
      attenuation_(*scene.medium),
      tolerance_(tolerance) {
    check_uniform(scene);
}

void QuadratureIntegrator::in_scatter(const Ray& ray, std::span<const double> distances,
                                      InScatter& result) const {
    const std::vector<Lamp>& emitters = *scene_.emitters;
    result.reset(distances.size(), scene_.lamp_count());
    for (std::size_t j = 0; j < emitters.size(); ++j) {
        throw_if_stopped();
        RayIntegral integral(*this, ray, j);
        Spectrum sum;
        double begin = 0;
        for (std::size_t i = 0; i < distances.size(); ++i) {
            sum += evenness_.of(emitters[j].index(), ray, {begin, distances[i]}) *
                   integral(begin, distances[i]);
            result.at(i, emitters[j].index()) += sum;
            begin = distances[i];
        }
    }
}

UniformWaterLighting::UniformWaterLighting(const LitScene& scene)
    : scene_(scene), attenuation_(*scene.medium) {
    check_uniform(scene);
}

void UniformWaterLighting::evaluate(std::span<const SurfaceSample* const> samples,
                                    SurfaceLight& light) const {
    const auto bands = static_cast<std::size_t>(attenuation_.band_count);
    light.reset(samples.size(), *scene_.emitters, bands);
    const auto set_transmittance = [&](std::span<double> transmittance, double length) {
        for (std::size_t b = 0; b < bands; ++b)
            transmittance[b] = std::exp(-attenuation_.uniform[b] * length);
    };
    find_half_shades(scene_, samples, light.visibilities());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto& [ray, hit, x, y] = *samples[i];
        set_transmittance(light.to_camera(i), distance(ray.origin, hit.position));
        for (std::size_t j = 0; j < scene_.emitters->size(); ++j) {
            const Lamp& lamp = (*scene_.emitters)[j];
            const Point3 origin = lamp.origin(hit.position);
            const Vector3 v = origin - hit.position;
            const double r2 = glm::dot(v, v);
            const auto* const sky = dynamic_cast<const SkyEmitter*>(&lamp.emitter());
            const auto towards_light = [&](const Vector3& normal) {
                return sky ? std::sqrt(r2) * sky->mean_cosine(normal) : glm::dot(normal, v);
            };
            const double geometry_term = lamp.relative_intensity(-v) * lamp.focus(hit.position) *
                                         towards_light(hit.normal) /
                                         (lamp.spread(std::sqrt(r2)) * std::sqrt(r2));
            if (geometry_term <= 0 || towards_light(hit.geometric_normal) <= 0) continue;
            double& visibility = light.visibility(i, j);
            if (!lamp.is_part())
                visibility = scene_.surfaces->occluded(origin, hit.position) ? 0 : 1;
            if (visibility == 0) continue;
            light.geometry_term(i, j) = visibility * geometry_term;
            set_transmittance(light.from_emitter(i, j), std::sqrt(r2));
        }
    }
}

}  // namespace uw
