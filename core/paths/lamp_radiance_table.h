#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/light/half_tangent_density.h"

namespace uw {

/// The scattered radiance around a point lamp in infinite water, of all orders: for attenuation 1
/// and intensity 1, by distance, angle to the lamp and albedo. For guiding: only the variance of
/// paths depends on it. Angles psi are given as h = tan(psi / 2), distances as optical depths.
///
/// Order n + 1 is computed from order n by applying the phase function and marching along rays. The
/// orders of albedo 1 are summed with the powers of three albedos at once.
class LampRadianceTable {
  public:
    /// The accuracy of the tables.
    struct Fineness {
        int orders = 400;  // the maximum order; the series ends earlier where more add nothing
        bool is_coarse = false;  // with a quarter of the nodes and steps twice as long
    };

    /// An empty table, which must not be looked up.
    LampRadianceTable() = default;
    /// `direction`, `line`: ScatteringTables::directions and lines of the phase function.
    LampRadianceTable(const HalfTangentDensity& direction, const HalfTangentDensity& line,
                      double min_albedo, double max_albedo, const Fineness& fineness);

    /// The position in the table for one distance and albedo.
    struct Place {
        std::array<std::size_t, 4> row{};
        std::array<float, 4> weight{};
        std::size_t lobe = 0;
        float beyond = 0;  // to be subtracted from the logarithms beyond the last radius
        double radius = 1;
    };
    Place at(double radius, double albedo) const;

    /// The radiance from the angle `h` to the lamp: of all orders, and of all but single
    /// scattering; and `source`, the mean of all orders over the phase function around that
    /// direction.
    double radiance(const Place& place, double h) const {
        return look_up(all_, place, h) * over_sine(place, h) * below_table(h);
    }
    double multiple(const Place& place, double h) const {
        return look_up(multiple_, place, h) * over_sine(place, h);
    }
    double source(const Place& place, double h) const {
        return look_up(source_, place, h) / place.radius;
    }
    /// The squared distance times the net flux away from the lamp, with the unscattered light: 1 at
    /// the lamp, decreasing with distance.
    double flux(const Place& place) const;
    /// A density over h in proportion to the radiance, for sampling directions.
    const HalfTangentDensity& lobe(const Place& place) const { return lobes_[place.lobe]; }
    /// The phase function as a density over h. Parallel light scattered once has its shape; that of
    /// a nearby lamp has the shape of its integral.
    const HalfTangentDensity& phase() const { return phase_; }

  private:
    class Solver;

    static double over_sine(const Place& place, double h) {
        const double bounded = h < 1000 ? h : 1000;
        return (1 + bounded * bounded) / (2 * bounded * place.radius);
    }
    double look_up(const std::vector<float>& table, const Place& place, double h) const;
    // The radiance at angles below the first of the tables, relative to that at the first. There
    // single scattering dominates, which diverges where the phase function does.
    double below_table(double h) const;

    HalfTangentDensity phase_, line_;
    double line_in_table_ = 1;  // integral of `line_` beyond the first angle
    double min_albedo_ = 0, albedo_step_ = 1;
    std::vector<float> decay_;  // slope of the logarithms beyond the last radius, by albedo
    std::vector<float> all_, multiple_, source_;  // logarithms, [(albedo, radius, h)]
    std::vector<float> flux_;                     // logarithms, [(albedo, radius)]
    std::vector<HalfTangentDensity> lobes_;       // by every k_lobe_stride-th radius
};

}  // namespace uw
