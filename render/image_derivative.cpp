#include "render/image_derivative.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "media/water/water_model.h"
#include "render/exposure.h"

namespace uw {

namespace {

constexpr std::string_view k_concentration = "concentration.";
constexpr std::string_view k_small = "water.particles.small", k_large = "water.particles.large";

void refuse_other_light(const AssembledScene& scene, const std::string& name) {
    const auto refuse = [&](const char* what) {
        throw UsageError(fmt::format("derivative {}: {}", name, what));
    };
    if (scene.desc().render.integrator != RenderDesc::Integrator::volume)
        refuse(
            "it is computed term by term from the sums of integrator volume, which others do not "
            "have; choose integrator volume");
    const LayerPlan plan = layer_plan(scene.image, {});
    if (plan.is_provided(Layer::multiple))
        refuse(
            "light scattered more than once is the mean over random paths and has none; set "
            "render.scattering to single, whose image this is the derivative of");
    if (plan.is_provided(Layer::forward))
        refuse(
            "forward scatter blurs the finished image, and how is not differentiated; remove "
            "water.forward_scatter, or set its K to 0");
    if (plan.is_provided(Layer::snow))
        refuse("marine snow is drawn particle by particle and has none; remove water.snow");
    if (Exposure(scene).part_count() > 0)
        refuse(
            "it is that of a single moment, not of the mean over an exposure; set render.shutter "
            "and camera.line_time to 0");
}

/// Coefficients with the same attenuation, of which `scattering` is scattered.
OpticalCoefficients with_scattering(const OpticalCoefficients& coefficients,
                                    std::vector<Spectrum> scattering) {
    OpticalCoefficients changed{coefficients.attenuation(), std::move(scattering)};
    for (const Spectrum& b : changed.scattering) changed.absorption -= b;
    return changed;
}

using PhaseFunctions = std::vector<std::shared_ptr<const PhaseFunction>>;

/// The medium in which nothing scatters that did, but everything attenuates as before, to scatter
/// by these phase functions.
Medium without_scattering(const Medium& medium, PhaseFunctions phases) {
    Medium dark = medium;
    const std::vector<Spectrum> nothing(phases.size());
    dark.phase_functions = std::move(phases);
    dark.uniform = with_scattering(medium.uniform, nothing);
    for (Constituent& constituent : dark.constituents)
        constituent.per_unit = with_scattering(constituent.per_unit, nothing);
    return dark;
}

Medium without_scattering(const Medium& medium) {
    return without_scattering(medium, medium.phase_functions);
}

/// Sums images of a scene with other light transports.
class DerivativeSum {
  public:
    DerivativeSum(Renderer& renderer, const RenderOptions& options)
        : renderer_(renderer), options_(options) {
        options_.layers = "direct,backscatter";
    }

    /// Adds the light of surfaces, unless it is left out, and of the water, times a factor per
    /// band.
    void add(const Medium& medium, const PathWeight& weight, bool with_surfaces,
             const Spectrum& factor) {
        const LightTransport transport =
            make_single_scattering(renderer_.assembled(), renderer_.splat(), medium, weight);
        options_.transport = &transport;
        const Film& film = renderer_.render(options_);
        const LayerPlan plan = layer_plan(renderer_.scene(), options_.layers);
        const auto direct = static_cast<std::size_t>(plan.first_channel(Layer::direct));
        const auto water = static_cast<std::size_t>(plan.first_channel(Layer::backscatter));
        const std::size_t bands = plan.band_count(), channels = film.channel_names().size();
        const std::span<const float> values = film.values();
        sum_.resize(values.size() / channels * bands);
        for (std::size_t pixel = 0; pixel < values.size() / channels; ++pixel)
            for (std::size_t b = 0; b < bands; ++b) {
                const std::size_t first = pixel * channels + b;
                const double light = (with_surfaces ? double{values[first + direct]} : 0.0) +
                                     double{values[first + water]};
                sum_[pixel * bands + b] += static_cast<float>(factor[b] * light);
            }
    }
    std::vector<float> take() && { return std::move(sum_); }

  private:
    Renderer& renderer_;
    RenderOptions options_;
    std::vector<float> sum_;
};

Spectrum ones(const Medium& medium) {
    Spectrum one;
    for (std::size_t b = 0; b < medium.wavelengths_nm.size(); ++b) one[b] = 1;
    return one;
}

/// The uniform water's phase function by itself: its parts, per unit of scattering.
std::vector<Spectrum> shares_of_scattering(const Medium& medium) {
    const Spectrum total = medium.uniform.total_scattering();
    std::vector<Spectrum> shares = medium.uniform.scattering;
    for (std::size_t b = 0; b < medium.wavelengths_nm.size(); ++b) {
        if (!(total[b] > 0))
            throw UsageError(
                fmt::format("derivative water.scattering: the water does not scatter at {:g} nm, "
                            "so that its phase function is unknown; give it some scattering",
                            medium.wavelengths_nm[b]));
        for (Spectrum& share : shares) share[b] /= total[b];
    }
    return shares;
}

ParticleDerivative derivative_by_particles(const AssembledScene& scene, const std::string& name) {
    try {
        return particle_derivative(scene.desc().water, scene.desc().volumes,
                                   name == k_small ? WaterParticles::small : WaterParticles::large);
    } catch (const UsageError& fault) {
        throw UsageError(fmt::format("derivative {}: {}", name, fault.what()));
    }
}

std::size_t constituent_called(const std::string& name, const Medium& medium) {
    const std::string_view wanted = std::string_view(name).substr(k_concentration.size());
    const auto found = std::ranges::find(medium.constituents, wanted, &Constituent::name);
    if (found == medium.constituents.end()) {
        std::string there;
        for (const Constituent& constituent : medium.constituents)
            there += (there.empty() ? "" : ", ") + printable(constituent.name);
        throw UsageError(fmt::format("derivative {}: the volumes hold {}", printable(name),
                                     there.empty() ? "nothing" : there));
    }
    return static_cast<std::size_t>(found - medium.constituents.begin());
}

}  // namespace

std::vector<float> image_derivative(Renderer& renderer, const std::string& name,
                                    const RenderOptions& options) {
    const AssembledScene& scene = renderer.assemble();
    refuse_other_light(scene, printable(name));
    const Medium& medium = scene.water.medium;
    DerivativeSum sum(renderer, options);
    const Spectrum one = ones(medium), minus = -1.0 * one;
    if (name.starts_with(k_concentration)) {
        const std::size_t k = constituent_called(name, medium);
        const OpticalCoefficients& per_unit = medium.constituents[k].per_unit;
        Medium itself = without_scattering(medium);
        itself.constituents[k].per_unit = per_unit;
        sum.add(medium, {PathWeight::Kind::column, k}, true, minus * per_unit.attenuation());
        sum.add(itself, {}, false, one);
        return std::move(sum).take();
    }
    if (name == k_small || name == k_large) {
        ParticleDerivative particles = derivative_by_particles(scene, name);
        Medium themselves = without_scattering(medium, std::move(particles.phase_functions));
        themselves.uniform = with_scattering(medium.uniform, particles.per_ppm.scattering);
        sum.add(medium, {PathWeight::Kind::length, 0}, true,
                minus * particles.per_ppm.attenuation());
        sum.add(themselves, {}, false, one);
        return std::move(sum).take();
    }
    constexpr std::array<std::string_view, 2> k_names{"water.absorption", "water.scattering"};
    if (std::ranges::find(k_names, name) == k_names.end())
        throw UsageError(
            fmt::format("derivative '{}': unknown; use water.absorption, "
                        "water.scattering, water.particles.small, water.particles.large or "
                        "concentration.NAME of a constituent",
                        printable(name)));
    if (name == "water.scattering") {
        Medium itself = without_scattering(medium);
        itself.uniform = with_scattering(medium.uniform, shares_of_scattering(medium));
        sum.add(itself, {}, false, one);
    }
    sum.add(medium, {PathWeight::Kind::length, 0}, true, minus);
    return std::move(sum).take();
}

}  // namespace uw
