#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/paths/half_tangent_density.h"

namespace uw {

/// The light around a point lamp in infinite water that the water has scattered, all orders of it:
/// for attenuation 1 and intensity 1, by distance, angle to the lamp and albedo. It guides paths,
/// so that it may be rough: nothing but their variance depends on it. Angles psi are given as h =
/// tan(psi / 2), distances in optical depths.
///
/// Tables of the order n + 1 are those of order n, scattered once more and marched along rays; they
/// are made for albedo 1 and added up for three albedos at once.
class LampRadianceTable {
  public:
    /// How closely it is found.
    struct Fineness {
        int orders = 400;        // the most scatterings; fewer where more would add nothing
        bool is_coarse = false;  // on a lattice of a quarter of the nodes, by steps twice as long
    };

    /// Not to be looked up.
    LampRadianceTable() = default;
    /// `direction`, `line`: ScatteringTables::directions and lines of the phase function.
    LampRadianceTable(const HalfTangentDensity& direction, const HalfTangentDensity& line,
                      double min_albedo, double max_albedo, const Fineness& fineness);

    /// Where to look up, for one distance and albedo.
    struct Place {
        std::array<std::size_t, 4> row{};
        std::array<float, 4> weight{};
        std::size_t lobe = 0;
        float beyond = 0;  // what is to be subtracted from logarithms beyond the table
        double radius = 1;
    };
    Place at(double radius, double albedo) const;

    /// The radiance that arrives from the angle `h` to the lamp, of all orders and without the
    /// first; and the mean over the phase function around that direction, of all orders.
    double radiance(const Place& place, double h) const {
        return look_up(all_, place, h) * over_sine(place, h) * below_table(h);
    }
    double multiple(const Place& place, double h) const {
        return look_up(more_, place, h) * over_sine(place, h);
    }
    double source(const Place& place, double h) const {
        return look_up(source_, place, h) / place.radius;
    }
    /// The squared distance times the net flux away from the lamp, unscattered light included: 1 at
    /// the lamp, and less with the distance.
    double flux(const Place& place) const;
    /// A density over h in the shape of the radiance.
    const HalfTangentDensity& lobe(const Place& place) const { return lobes_[place.lobe]; }
    /// The phase function, as a density over h: parallel light that is scattered once has its
    /// shape, where that of a lamp, which is near, has the shape of its integrals.
    const HalfTangentDensity& phase() const { return phase_; }

  private:
    class Solver;

    static double over_sine(const Place& place, double h) {
        const double bounded = h < 1000 ? h : 1000;
        return (1 + bounded * bounded) / (2 * bounded * place.radius);
    }
    double look_up(const std::vector<float>& table, const Place& place, double h) const;
    // The light at angles that the tables do not reach, relative to that at their first: what is
    // scattered once there decides, which grows for ever where a phase function does.
    double below_table(double h) const;

    HalfTangentDensity phase_, line_;
    double line_in_table_ = 1;  // of `line_`, beyond the tables' first angle
    double min_albedo_ = 0, albedo_step_ = 1;
    std::vector<float> decay_;                // of the logarithms beyond the table, by albedo
    std::vector<float> all_, more_, source_;  // logarithms, [(albedo, radius, h)]
    std::vector<float> flux_;                 // logarithms, [(albedo, radius)]
    std::vector<HalfTangentDensity> lobes_;   // by radius, roughly
};

}  // namespace uw
