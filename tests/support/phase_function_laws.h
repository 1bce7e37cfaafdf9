#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "core/light/phase_function.h"
#include "tests/support/adaptive_quadrature.h"

/// The laws that every PhaseFunction obeys, so that each class is tested in one line.
namespace uw::test {

/// 2 pi int_0^pi f(psi) sin(psi) dpsi for an f that may peak by many decades at psi = 0: constant
/// below 1e-8 rad, in ln psi from there to 0.1 rad, in psi beyond. About 1e-8 absolute.
inline double integral_over_sphere(const std::function<double(double)>& f) {
    const double pi = std::numbers::pi;
    const double smallest = 1e-8, seam = 0.1;
    double sum = f(0) * smallest * smallest / 2;
    const auto in_log = [&](double u) {
        const double psi = std::exp(u);
        return f(psi) * std::sin(psi) * psi;
    };
    const int panels = 40;  // so that no narrow feature is missed by the first subdivisions
    for (int i = 0; i < panels; ++i) {
        const double u_0 = std::log(smallest), step = (std::log(seam) - u_0) / panels;
        sum += AdaptiveQuadrature::integrate(in_log, u_0 + i * step, u_0 + (i + 1) * step, 1e-11);
        const double width = (pi - seam) / panels;
        sum += AdaptiveQuadrature::integrate([&](double psi) { return f(psi) * std::sin(psi); },
                                             seam + i * width, seam + (i + 1) * width, 1e-11);
    }
    return 2 * pi * sum;
}

/// The fraction of the scattering by `p` at angles between `from` >= 0 and `to`, to about 1e-5.
inline double scattered_between(const PhaseFunction& p, double from, double to) {
    constexpr int k_panels = 8;
    const double u = std::log(std::max(from, 1e-8)), step = (std::log(to) - u) / k_panels;
    const auto in_log = [&](double v) {
        const double psi = std::exp(v);
        return 2 * std::numbers::pi * p.eval(psi) * std::sin(psi) * psi;
    };
    double sum = 0;
    for (int i = 0; i < k_panels; ++i)
        sum += AdaptiveQuadrature::integrate(in_log, u + i * step, u + (i + 1) * step, 1e-7);
    return sum;
}

/// Checks that angles are sampled as `p` is evaluated: equal parts of the random numbers from 0 to
/// 1 get equal parts of the scattering, pdf() is the density of these samples, and its integral
/// is 1.
inline void expect_sampled_as_evaluated(const PhaseFunction& p) {
    SCOPED_TRACE(p.description());
    const HalfTangentDensity sampler = p.make_sampler();
    // The pdf is linear between nodes, so that the trapezoidal rule is exact.
    const auto integral_to = [&](double h) {
        double sum = 0, before = 0;
        for (const double node : HalfTangentDensity::nodes()) {
            const double end = std::min(node, h);
            sum += 0.5 * (sampler.pdf(before) + sampler.pdf(end)) * (end - before);
            before = end;
        }
        return sum;
    };
    constexpr int k_parts = 16;
    double before = 0;
    for (int i = 1; i <= k_parts; ++i) {
        const double u = static_cast<double>(i) / k_parts, h = sampler.sample(u);
        const double psi = 2 * std::atan(h);
        // The pdf is 0 at the last node, pi - 1.2e-7 rad, and beyond.
        const double last = std::nextafter(HalfTangentDensity::nodes().back(), 0);
        EXPECT_NEAR(integral_to(std::min(h, last)), u, 1e-9);
        // Straight lines between 16 nodes per octave are off by (ln 2 / 16)^2 / 12 = 1.6e-4 of the
        // second derivative of the density by ln h, which is a few times the density; and by an
        // eighth of their width squared times the change of slope at the corners of a table, 2e-3
        // for a tent 60 degrees wide.
        EXPECT_NEAR(scattered_between(p, before, psi), 1.0 / k_parts, 2e-3) << "up to " << psi;
        before = psi;
    }
}

/// Checks that `p` integrates to 1, is finite and not negative from 0 to pi, gives the same value
/// alone and in a batch, and lists ascending breakpoints inside (0, pi); and that its mean cosine
/// is `g`, if that is given. It is reciprocal by its type, since it knows the angle alone.
inline void expect_evaluation_laws(const PhaseFunction& p, std::optional<double> g = {}) {
    SCOPED_TRACE(p.description());
    const double pi = std::numbers::pi;
    EXPECT_NEAR(integral_over_sphere([&](double psi) { return p.eval(psi); }), 1.0, 1e-6);
    if (g) {
        EXPECT_NEAR(integral_over_sphere([&](double psi) { return p.eval(psi) * std::cos(psi); }),
                    *g, 1e-6);
    }

    std::vector<double> psi{0, pi, std::nextafter(pi, 0.0), 1e-300, 1e-12, 1e-7, 1e-6, 1e-5};
    for (int i = 1; i < 1000; ++i) psi.push_back(pi * i / 1000);
    const std::vector<double> breakpoints = p.breakpoints();
    psi.insert(psi.end(), breakpoints.begin(), breakpoints.end());
    std::vector<double> batch(psi.size());
    p.eval(psi, batch);
    for (std::size_t i = 0; i < psi.size(); ++i) {
        EXPECT_TRUE(std::isfinite(batch[i])) << "psi = " << psi[i];
        EXPECT_GE(batch[i], 0) << "psi = " << psi[i];
        EXPECT_EQ(batch[i], p.eval(psi[i])) << "psi = " << psi[i];
    }

    EXPECT_TRUE(std::is_sorted(breakpoints.begin(), breakpoints.end(), std::less_equal<>()));
    for (const double angle : breakpoints) {
        EXPECT_GT(angle, 0);
        EXPECT_LT(angle, pi);
    }
    EXPECT_FALSE(p.description().empty());
}

/// All of these laws.
inline void expect_phase_function_laws(const PhaseFunction& p, std::optional<double> g = {}) {
    expect_evaluation_laws(p, g);
    expect_sampled_as_evaluated(p);
}

}  // namespace uw::test
