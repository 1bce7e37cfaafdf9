#include "core/snow/snow_medium.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numbers>

#include "core/base/error.h"
#include "core/snow/junge_sizes.h"
#include "core/snow/lambert_sphere.h"

namespace uw {
namespace {

/// Lets the uniform water scatter `b` more, as diffuse spheres do, while its attenuation stays.
/// What is added and taken away again leaves nothing: both are of one phase function.
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

/// Lets `x` absorb what it scattered.
void stop_scattering(OpticalCoefficients& x) {
    x.absorption = x.attenuation();
    for (Spectrum& b : x.scattering) b = {};
}

void check_rest(const SnowDesc& snow, const Medium& water, const Spectrum& b) {
    constexpr int k_steps = 360;
    // What is added to the coefficients and taken away again leaves rounding behind.
    constexpr double k_rounding = 1e-9;
    for (int i = 0; i <= k_steps; ++i) {
        const double psi = std::numbers::pi * i / k_steps;
        Spectrum beta;
        for (std::size_t m = 0; m < water.phase_functions.size(); ++m)
            beta += water.uniform.scattering[m] * water.phase_functions[m]->evaluate(psi);
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

}  // namespace uw
