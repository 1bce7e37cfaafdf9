#include "core/light/sky_quadrature.h"

#include <numbers>

#include "core/base/numerics.h"

namespace uw {

void SkyQuadrature::set_columns(std::size_t count, double first) {
    first_azimuth = first;
    column_width = 2 * std::numbers::pi / static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double azimuth = first + (static_cast<double>(i) + 0.5) * column_width;
        column_sines.push_back(std::sin(azimuth));
        column_cosines.push_back(std::cos(azimuth));
    }
}

// Gauss's rule with two nodes of the cosine in each interval of the angle is exact for cubics, and
// the midpoint rule converges quickly for periodic functions.
SkyQuadrature SkyQuadrature::even(double first) {
    constexpr int k_intervals = 64;
    constexpr std::size_t k_columns = 256;
    SkyQuadrature quadrature;
    quadrature.set_columns(k_columns, first);
    const std::span<const QuadratureNode> nodes = gauss_legendre(2);
    const double near = std::min(nodes[0].position, nodes[1].position);
    for (int i = 0; i < k_intervals; ++i) {
        const auto cosine_at = [](int edge) {
            return std::cos(0.5 * std::numbers::pi * edge / k_intervals);
        };
        const double upper = cosine_at(i), lower = i + 1 < k_intervals ? cosine_at(i + 1) : 0;
        for (const double position : {near, 1 - near})
            quadrature.rows.push_back({upper + position * (lower - upper),
                                       0.5 * (upper - lower) * quadrature.column_width});
    }
    quadrature.set_edges();
    return quadrature;
}

void SkyQuadrature::set_edges() {
    double cosine = 1;
    row_cosines = {1};
    row_sines = {0};
    for (const Row& row : rows) {
        cosine -= row.solid_angle / column_width;
        const double clamped = std::max(0.0, cosine);
        row_cosines.push_back(clamped);
        row_sines.push_back(std::sqrt(1 - clamped * clamped));
    }
}

}  // namespace uw
