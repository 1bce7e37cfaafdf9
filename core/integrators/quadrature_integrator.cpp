#include "core/integrators/quadrature_integrator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace uw {

namespace {

// Initial panels of the quadrature: narrower than a phase function's forward peak where it matters,
// so that no feature is missed between the first nodes.
constexpr int k_first_panels = 48;
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

/// The integral of one lamp's light along one ray over the angle psi.
class QuadratureIntegrator::RayIntegral {
  public:
    RayIntegral(const QuadratureIntegrator& owner, const Ray& ray, const Lamp& lamp)
        : owner_(owner), ray_(ray), lamp_(lamp) {
        const Vector3 to_lamp = lamp.position() - ray.origin;
        foot_ = glm::dot(to_lamp, ray.direction);
        // A ray straight through the lamp has no angle to integrate over, but one that narrowly
        // misses it does.
        distance_ = std::max(1e-9, glm::length(to_lamp - foot_ * ray.direction));
    }

    /// In-scatter from `begin` to `end` along the ray.
    Spectrum operator()(double begin, double end) {
        const double from = angle(begin), to = angle(end);
        std::array<Spectrum, 2 * k_first_panels + 1> f;
        for (std::size_t i = 0; i < f.size(); ++i)
            f[i] = integrand(from + (to - from) * static_cast<double>(i) / (2 * k_first_panels));
        const double h = (to - from) / k_first_panels;
        std::array<Spectrum, k_first_panels> coarse;
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
    double angle(double s) const { return std::atan2(distance_, foot_ - s); }

    Spectrum integrand(double psi) const {
        const double tangent = std::tan(0.5 * psi);
        const double s = foot_ - distance_ / std::tan(psi);
        const Point3 x = ray_.at(s);
        const double relative = lamp_.relative_intensity(x - lamp_.position());
        Spectrum value{};
        if (relative <= 0 || owner_.scene_.surfaces->occluded(lamp_.position(), x)) return value;
        const Medium& medium = *owner_.scene_.medium;
        for (std::size_t m = 0; m < medium.phase_functions.size(); ++m) {
            const double p = medium.phase_functions[m]->evaluate(psi);
            value += medium.uniform.scattering[m] * p;
        }
        value *= per_band(static_cast<std::size_t>(medium.band_count()), [&](std::size_t b) {
            return lamp_.axis_intensity()[b] * relative / distance_ *
                   std::exp(-owner_.attenuation_.uniform[b] * (foot_ + distance_ * tangent));
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
    double foot_ = 0;
    double distance_ = 0;
    Spectrum scale_{};  // a first estimate of the integral, per band
};

QuadratureIntegrator::QuadratureIntegrator(const LitScene& scene, double tolerance)
    : scene_(scene), attenuation_(*scene.medium), tolerance_(tolerance) {
    check_uniform(scene);
}

void QuadratureIntegrator::in_scatter(const Ray& ray, std::span<const double> distances,
                                      InScatter& result) const {
    const std::vector<Lamp>& emitters = *scene_.emitters;
    result.reset(distances.size(), scene_.lamp_count());
    for (std::size_t j = 0; j < emitters.size(); ++j) {
        RayIntegral integral(*this, ray, emitters[j]);
        Spectrum sum;
        double begin = 0;
        for (std::size_t i = 0; i < distances.size(); ++i) {
            sum += integral(begin, distances[i]);
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
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto& [ray, hit, x, y] = *samples[i];
        set_transmittance(light.to_camera(i), distance(ray.origin, hit.position));
        for (std::size_t j = 0; j < scene_.emitters->size(); ++j) {
            const Lamp& lamp = (*scene_.emitters)[j];
            const Vector3 v = lamp.position() - hit.position;
            const double r2 = glm::dot(v, v);
            const double geometry_term =
                lamp.relative_intensity(-v) * glm::dot(hit.normal, v) / (r2 * std::sqrt(r2));
            if (geometry_term <= 0 || glm::dot(hit.geometric_normal, v) <= 0 ||
                scene_.surfaces->occluded(lamp.position(), hit.position))
                continue;
            light.geometry_term(i, j) = geometry_term;
            set_transmittance(light.from_emitter(i, j), std::sqrt(r2));
        }
    }
}

}  // namespace uw
