#include "core/light/sky_emitter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/numerics.h"
#include "core/light/phase_function.h"

namespace uw {

SkyEmitter::SkyEmitter(const Sunlight& sunlight, const LampPatch& patch,
                       std::shared_ptr<const SkyParts> parts, std::size_t part,
                       const Matrix3& world_from_sky, const Spectrum& irradiance)
    : DirectionalEmitter(sunlight, patch),
      parts_(std::move(parts)),
      number_(part),
      world_from_sky_(world_from_sky),
      irradiance_(irradiance) {}

Point3 SkyEmitter::origin_on_patch(const Point3& x, const UnitPoint& place) const {
    const Vector3 towards = sample(place.u, place.v);
    return x + length_to(x, towards) * towards;
}

Spectrum SkyEmitter::radiance(const Vector3& towards, const Lamp& lamp) const {
    Spectrum radiance = parts_->radiance(in_sky(towards));
    for (std::size_t b = 0; b < k_max_bands; ++b)
        radiance[b] *= irradiance_[b] > 0 ? lamp.axis_intensity()[b] / irradiance_[b] : 0;
    return radiance;
}

double SkyEmitter::mean_cosine(const Vector3& normal) const {
    const Vector3 n = in_sky(normal);
    const double sine = std::sin(std::min(part().half_angle, 0.5 * std::numbers::pi));
    const double cosine = glm::dot(n, part().in_water);
    if (cosine >= sine) return glm::dot(n, part().mean);  // none of it is behind the surface
    if (cosine <= -sine) return 0;
    double sum = 0;
    for (const SkyParts::Cell& cell : part().cells)
        sum += cell.weight * std::max(0.0, glm::dot(n, cell.towards));
    return sum;
}

double SkyEmitter::length_to(const Point3& x, const Vector3& towards) const {
    const WaterSurfaceDesc& surface = sunlight()->surface;
    return glm::dot(surface.normal, surface.point - x) / glm::dot(surface.normal, towards);
}

LampPassage SkyEmitter::passage_of(const Ray& ray, const Vector3& towards) const {
    const Vector3& up = sunlight()->surface.normal;
    LampPassage passage;
    passage.parallel = true;
    passage.begin_length = length_to(ray.origin, towards);
    passage.slope = -glm::dot(up, ray.direction) / glm::dot(up, towards);
    passage.tangent = half_tangent_between(towards, ray.direction);
    return passage;
}

bool SkyEmitter::equals(const Emitter& other) const {
    const auto& sky = static_cast<const SkyEmitter&>(other);
    return DirectionalEmitter::equals(other) && number_ == sky.number_ &&
           irradiance_ == sky.irradiance_ && world_from_sky_ == sky.world_from_sky_;
}

std::vector<const SkyEmitter*> sky_emitters(const std::vector<Lamp>& emitters) {
    std::vector<const SkyEmitter*> skies;
    for (const Lamp& lamp : emitters)
        skies.push_back(dynamic_cast<const SkyEmitter*>(&lamp.emitter()));
    if (std::ranges::none_of(skies, [](const SkyEmitter* sky) { return sky != nullptr; }))
        skies.clear();
    return skies;
}

namespace {

// The width of the blur, relative to the side of a square cell: neighbouring cells are wide enough
// to add up to an even sky within 1 % in the forward peak of any phase function, oblong ones
// included.
constexpr double k_blur_of_cell = 0.75;

/// A phase function blurred on the sphere by a Gaussian of variance sigma^2 along each axis (the
/// heat kernel): its Legendre moments are those of the function times e^(-l (l + 1) sigma^2 / 2).
/// The forward peak, of which a mean over few directions would find too much or nothing, keeps its
/// energy.
class BlurredPhaseFunction final : public PhaseFunction {
  public:
    BlurredPhaseFunction(const PhaseFunction& sharp, double sigma)
        : flat_(0.05 * sigma), coefficients_(static_cast<std::size_t>(6.5 / sigma) + 2, 0.0) {
        add_moments(sharp);
        for (std::size_t l = 0; l < coefficients_.size(); ++l) {
            const auto order = static_cast<double>(l);
            coefficients_[l] *= (2 * order + 1) / (4 * std::numbers::pi) *
                                std::exp(-0.5 * order * (order + 1) * sigma * sigma);
        }
        forward_ = sum(1);
        backward_ = sum(-1);
    }

    void eval(std::span<const double> psi, std::span<double> p) const override {
        for (std::size_t i = 0; i < psi.size(); ++i)
            p[i] = psi[i] < flat_                      ? forward_
                   : std::numbers::pi - psi[i] < flat_ ? backward_
                                                       : sum(std::cos(psi[i]));
    }
    std::string description() const override { return "blurred"; }

  private:
    // Calls `visit` with the order and value of each Legendre polynomial at x.
    template <class Visit>
    void for_each_polynomial(double x, const Visit& visit) const {
        double before = 0, value = 1;
        for (std::size_t l = 0; l < coefficients_.size(); ++l) {
            visit(l, value);
            const auto order = static_cast<double>(l);
            const double next = ((2 * order + 1) * x * value - order * before) / (order + 1);
            before = std::exchange(value, next);
        }
    }
    double sum(double x) const {
        double sum = 0;
        for_each_polynomial(x,
                            [&](std::size_t l, double value) { sum += coefficients_[l] * value; });
        return std::max(0.0, sum);
    }
    // The moments 2 pi int p P_l sin(psi) dpsi, by Gauss's rule on small steps of ln tan(psi / 2).
    void add_moments(const PhaseFunction& sharp) {
        constexpr int k_steps_per_octave = 64;
        const double min_octave = std::log2(k_min_half_tangent);
        const double max_octave = std::log2(k_max_half_tangent);
        const int steps = static_cast<int>((max_octave - min_octave) * k_steps_per_octave);
        std::vector<double> psi, weight;
        for (int step = 0; step < steps; ++step)
            for (const QuadratureNode& node : gauss_legendre(2)) {
                const double h =
                    std::exp2(min_octave + (step + node.position) / k_steps_per_octave);
                const double per_h = 8 * std::numbers::pi * h / ((1 + h * h) * (1 + h * h));
                psi.push_back(2 * std::atan(h));
                weight.push_back(node.weight * std::numbers::ln2 / k_steps_per_octave * h * per_h);
            }
        std::vector<double> p(psi.size());
        sharp.eval(psi, p);
        for (std::size_t i = 0; i < psi.size(); ++i)
            for_each_polynomial(std::cos(psi[i]), [&](std::size_t l, double value) {
                coefficients_[l] += weight[i] * p[i] * value;
            });
    }

    double flat_;  // an angle from both ends up to which nothing changes [rad]
    std::vector<double> coefficients_;
    double forward_ = 0, backward_ = 0;
};

}  // namespace

SkyScattering::SkyScattering(const LitScene& scene) : skies_(sky_emitters(*scene.emitters)) {
    const auto sky =
        std::ranges::find_if(skies_, [](const SkyEmitter* emitter) { return emitter != nullptr; });
    if (sky == skies_.end()) return;
    const double sigma = k_blur_of_cell * std::sqrt((*sky)->parts().cell_solid_angle());
    Medium blurred = *scene.medium;
    for (std::shared_ptr<const PhaseFunction>& phase : blurred.phase_functions)
        phase = std::make_shared<BlurredPhaseFunction>(*phase, sigma);
    phases_.emplace(blurred);
    phase_fractions_ = typical_phase_fractions(*scene.medium);
}

double SkyScattering::find(std::size_t emitter, const Vector3& direction,
                           std::vector<double>& phase, Workspace& w) const {
    const SkyEmitter& sky = *skies_[emitter];
    const std::vector<SkyParts::Cell>& cells = sky.part().cells;
    const std::size_t count = cells.size(), phases = phase_fractions_.size();
    const Vector3 in_sky = sky.in_sky(direction);
    w.half_tangents.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double cosine = std::clamp(glm::dot(cells[i].towards, in_sky), -1.0, 1.0);
        w.half_tangents[i] = std::sqrt((1 - cosine) / (1 + cosine));
    }
    w.p.resize(count * phases);
    phases_->eval(w.half_tangents, w.p);
    phase.assign(phases, 0.0);
    double left = 0, all = 0;
    for (std::size_t m = 0; m < phases; ++m) {
        double transmitted = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double p = cells[i].weight * w.p[m * count + i];
            phase[m] += p;
            transmitted += p * cells[i].transmittance;
        }
        all += phase_fractions_[m] * phase[m];
        left += phase_fractions_[m] * transmitted;
    }
    return left > 0 ? -std::log(left / all) / SkyParts::k_depth_of_transmittance : 1;
}

}  // namespace uw
