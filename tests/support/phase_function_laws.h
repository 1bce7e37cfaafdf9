#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/light/medium.h"

/// The laws that every PhaseFunction obeys, so that each class is tested in one line.
namespace uw::test {

/// Adaptive Simpson of f over [a, b] to the absolute tolerance; knows nothing of f's structure.
inline double adaptive_simpson(const std::function<double(double)>& f, double a, double fa,
                               double m, double fm, double b, double fb, double whole,
                               double tolerance, int depth) {
    const double left_m = 0.5 * (a + m), right_m = 0.5 * (m + b);
    const double f_left = f(left_m), f_right = f(right_m);
    const double left = (m - a) / 6 * (fa + 4 * f_left + fm);
    const double right = (b - m) / 6 * (fm + 4 * f_right + fb);
    const double difference = left + right - whole;
    if (depth == 0 || std::abs(difference) < 15 * tolerance) return left + right + difference / 15;
    return adaptive_simpson(f, a, fa, left_m, f_left, m, fm, left, tolerance / 2, depth - 1) +
           adaptive_simpson(f, m, fm, right_m, f_right, b, fb, right, tolerance / 2, depth - 1);
}

inline double adaptive_simpson(const std::function<double(double)>& f, double a, double b,
                               double tolerance) {
    const double m = 0.5 * (a + b);
    const double fa = f(a), fm = f(m), fb = f(b);
    return adaptive_simpson(f, a, fa, m, fm, b, fb, (b - a) / 6 * (fa + 4 * fm + fb), tolerance,
                            40);
}

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
        sum += adaptive_simpson(in_log, u_0 + i * step, u_0 + (i + 1) * step, 1e-11);
        const double width = (pi - seam) / panels;
        sum += adaptive_simpson([&](double psi) { return f(psi) * std::sin(psi); },
                                seam + i * width, seam + (i + 1) * width, 1e-11);
    }
    return 2 * pi * sum;
}

/// Checks that `p` integrates to 1, is finite and not negative from 0 to pi, gives the same value
/// alone and in a batch, and lists ascending breakpoints inside (0, pi).
inline void expect_phase_function_laws(const PhaseFunction& p) {
    SCOPED_TRACE(p.description());
    const double pi = std::numbers::pi;
    EXPECT_NEAR(integral_over_sphere([&](double psi) { return p.evaluate(psi); }), 1.0, 1e-6);

    std::vector<double> psi{0, pi, std::nextafter(pi, 0.0), 1e-300, 1e-12, 1e-7, 1e-6, 1e-5};
    for (int i = 1; i < 1000; ++i) psi.push_back(pi * i / 1000);
    const std::vector<double> breakpoints = p.breakpoints();
    psi.insert(psi.end(), breakpoints.begin(), breakpoints.end());
    std::vector<double> batch(psi.size());
    p.evaluate(psi, batch);
    for (std::size_t i = 0; i < psi.size(); ++i) {
        EXPECT_TRUE(std::isfinite(batch[i])) << "psi = " << psi[i];
        EXPECT_GE(batch[i], 0) << "psi = " << psi[i];
        EXPECT_EQ(batch[i], p.evaluate(psi[i])) << "psi = " << psi[i];
    }

    EXPECT_TRUE(std::is_sorted(breakpoints.begin(), breakpoints.end(), std::less_equal<>()));
    for (const double angle : breakpoints) {
        EXPECT_GT(angle, 0);
        EXPECT_LT(angle, pi);
    }
    EXPECT_FALSE(p.description().empty());
}

}  // namespace uw::test
