#include "render/navigation/pressure.h"

#include <cmath>
#include <numbers>

#include "core/base/numerics.h"

namespace uw {

namespace {

constexpr double k_bar = 1e5;  // [Pa]

/// The density at the surface, equation 13 of Fofonoff and Millard.
double density_at_surface(double s, double t) {
    const double pure =
        999.842594 +
        t * (6.793952e-2 +
             t * (-9.095290e-3 + t * (1.001685e-4 + t * (-1.120083e-6 + t * 6.536332e-9))));
    const double b =
        8.24493e-1 + t * (-4.0899e-3 + t * (7.6438e-5 + t * (-8.2467e-7 + t * 5.3875e-9)));
    const double c = -5.72466e-3 + t * (1.0227e-4 - t * 1.6546e-6);
    return pure + s * (b + c * std::sqrt(s) + 4.8314e-4 * s);
}

/// The secant bulk modulus [bar] at `p` [bar], equations 15 to 19.
double bulk_modulus(double s, double t, double p) {
    const double root = std::sqrt(s);
    const double b = 8.50935e-5 + t * (-6.12293e-6 + t * 5.2787e-8) +
                     s * (-9.9348e-7 + t * (2.0816e-8 + t * 9.1697e-10));
    const double a = 3.239908 + t * (1.43713e-3 + t * (1.16092e-4 - t * 5.77905e-7)) +
                     s * (2.2838e-3 - t * (1.0981e-5 + t * 1.6078e-6) + 1.91075e-4 * root);
    const double k = 19652.21 +
                     t * (148.4206 + t * (-2.327105 + t * (1.360477e-2 - t * 5.155288e-5))) +
                     s * (54.6746 + t * (-0.603459 + t * (1.09987e-2 - t * 6.1670e-5)) +
                          root * (7.944e-2 + t * (1.6483e-2 - t * 5.3009e-4)));
    return k + p * (a + p * b);
}

}  // namespace

double sea_water_density(double salinity, double temperature, double pressure) {
    const double bar = pressure / k_bar;
    return density_at_surface(salinity, temperature) /
           (1 - bar / bulk_modulus(salinity, temperature, bar));
}

WaterColumn::WaterColumn(double salinity, double temperature, double gravity)
    : salinity_(salinity), temperature_(temperature), gravity_(gravity) {}

double WaterColumn::depth_at(double pressure) const {
    // The integral of dp / (density g), whose integrand is so nearly linear that this many nodes
    // leave rounding alone.
    double depth = 0;
    for (const QuadratureNode& node : gauss_legendre(8))
        depth += node.weight * pressure /
                 sea_water_density(salinity_, temperature_, node.position * pressure);
    return depth / gravity_;
}

double WaterColumn::pressure_at(double depth) const {
    if (!(depth > 0) || gravity_ == 0) return 0;
    double pressure = density_at_surface(salinity_, temperature_) * gravity_ * depth;
    constexpr int k_newton_steps = 6;  // each squares an error that begins at a few percent
    for (int step = 0; step < k_newton_steps; ++step)
        pressure += (depth - depth_at(pressure)) *
                    sea_water_density(salinity_, temperature_, pressure) * gravity_;
    return pressure;
}

double tide_at(const PressureDesc& desc, double time) {
    if (!desc.tide) return 0;
    return desc.tide->amplitude *
           std::sin(2 * std::numbers::pi * (time / desc.tide->period + desc.tide->phase));
}

}  // namespace uw
