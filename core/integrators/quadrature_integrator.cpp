#include "core/integrators/quadrature_integrator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace uw {

namespace {

// Panels that the quadrature starts from: finer than a phase function's forward peak is wide where
// it matters, so that no feature hides between the first nodes.
constexpr int k_first_panels = 48;
constexpr int k_deepest_halving = 18;  // 2^-18 of a first panel at a shadow's edge

Spectrum combine(const Spectrum& a, const Spectrum& b, const Spectrum& c, double scale) {
    Spectrum sum{};
    for (std::size_t i = 0; i < k_max_bands; ++i) sum[i] = scale * (a[i] + 4 * b[i] + c[i]);
    return sum;
}

}  // namespace

/// The integral of one lamp's light along one ray over the angle psi.
class QuadratureIntegrator::RayIntegral {
  public:
    RayIntegral(const QuadratureIntegrator& owner, const Ray& ray, const Lamp& lamp)
        : owner_(owner), ray_(ray), lamp_(lamp) {
        const Vector3 to_lamp = lamp.position() - ray.origin;
        foot_ = glm::dot(to_lamp, ray.direction);
        // A ray straight through the lamp has no angle to integrate over; a hair beside it has.
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
            coarse[p] = combine(f[2 * p], f[2 * p + 1], f[2 * p + 2], h / 6);
            for (std::size_t b = 0; b < k_max_bands; ++b) scale_[b] += coarse[p][b];
        }
        Spectrum sum{};
        for (std::size_t p = 0; p < k_first_panels; ++p) {
            const double a = from + h * static_cast<double>(p);
            add(sum, refine(a, a + h, f[2 * p], f[2 * p + 1], f[2 * p + 2], coarse[p], 0));
        }
        return sum;
    }

  private:
    double angle(double s) const { return std::atan2(distance_, foot_ - s); }

    static void add(Spectrum& sum, const Spectrum& more) {
        for (std::size_t b = 0; b < k_max_bands; ++b) sum[b] += more[b];
    }

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
            for (std::size_t b = 0; b < static_cast<std::size_t>(medium.band_count()); ++b)
                value[b] += medium.uniform.scattering[m][b] * p;
        }
        for (std::size_t b = 0; b < static_cast<std::size_t>(medium.band_count()); ++b)
            value[b] *= lamp_.axis_intensity()[b] * relative / distance_ *
                        std::exp(-owner_.attenuation_.uniform[b] * (foot_ + distance_ * tangent));
        return value;
    }

    Spectrum refine(double a, double b, const Spectrum& fa, const Spectrum& fm, const Spectrum& fb,
                    const Spectrum& whole, int depth) {
        const double middle = 0.5 * (a + b);
        const Spectrum fl = integrand(0.5 * (a + middle)), fr = integrand(0.5 * (middle + b));
        const Spectrum left = combine(fa, fl, fm, (middle - a) / 6);
        const Spectrum right = combine(fm, fr, fb, (b - middle) / 6);
        bool done = true;
        Spectrum sum{};
        for (std::size_t i = 0; i < k_max_bands; ++i) {
            const double change = left[i] + right[i] - whole[i];
            // The tolerance is shared out evenly over the panels there would be at this depth.
            done = done && std::abs(change) <= 15 * owner_.tolerance_ * scale_[i] /
                                                   (k_first_panels * std::exp2(0.5 * depth));
            sum[i] = left[i] + right[i] + change / 15;
        }
        if (done || depth >= k_deepest_halving) return sum;
        sum = refine(a, middle, fa, fl, fm, left, depth + 1);
        add(sum, refine(middle, b, fm, fr, fb, right, depth + 1));
        return sum;
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
    if (scene.medium->constituent_count() > 0)
        throw std::invalid_argument("the quadrature integrator is for uniform water");
}

void QuadratureIntegrator::in_scatter(const Ray& ray, std::span<const double> ends,
                                      InScatter& result) const {
    const std::vector<Lamp>& lamps = *scene_.lamps;
    result.reset(ends.size(), lamps.size());
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        RayIntegral integral(*this, ray, lamps[j]);
        Spectrum sum{};
        double begin = 0;
        for (std::size_t end = 0; end < ends.size(); ++end) {
            const Spectrum part = integral(begin, ends[end]);
            for (std::size_t b = 0; b < k_max_bands; ++b) sum[b] += part[b];
            result.at(end, j) = sum;
            begin = ends[end];
        }
    }
}

void QuadratureIntegrator::surface_lights(std::span<const SurfaceSample* const> samples,
                                          SurfaceLight& light) const {
    const auto bands = static_cast<std::size_t>(attenuation_.band_count);
    const Spectrum& c = attenuation_.uniform;
    light.reset(samples.size(), *scene_.lamps, bands);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto& [ray, hit, x, y] = *samples[i];
        for (std::size_t b = 0; b < bands; ++b)
            light.to_camera(i)[b] = std::exp(-c[b] * distance(ray.origin, hit.position));
        for (std::size_t j = 0; j < scene_.lamps->size(); ++j) {
            const Lamp& lamp = (*scene_.lamps)[j];
            const Vector3 v = lamp.position() - hit.position;
            const double r2 = glm::dot(v, v);
            const double geometry_term =
                lamp.relative_intensity(-v) * glm::dot(hit.normal, v) / (r2 * std::sqrt(r2));
            if (geometry_term <= 0 || glm::dot(hit.geometric_normal, v) <= 0 ||
                scene_.surfaces->occluded(lamp.position(), hit.position))
                continue;
            light.geometry_term(i, j) = geometry_term;
            for (std::size_t b = 0; b < bands; ++b)
                light.from_lamp(i, j)[b] = std::exp(-c[b] * std::sqrt(r2));
        }
    }
}

}  // namespace uw
