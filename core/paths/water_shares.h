#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/integrators/ray_panels.h"
#include "core/paths/parallel_stretch.h"
#include "core/paths/path_state.h"
#include "core/paths/scattering_tables.h"
#include "core/paths/water_segment.h"

namespace uw {

/// Where on a segment a lamp's light is scattered once.
struct ScatterPlace {
    std::size_t lamp = 0;
    double s = 0;             // along the segment
    double half_tangent = 0;  // of the scattering angle
    double radius = 0;        // from the light's origin
    double density = 0;       // Lamp::spread times that of choosing it, per metre
};

/// The lamps' parts in the light that the water of a segment scatters, for choosing one of them and
/// a place: around a lamp by the scattering angle, in a sun's light by its attenuation. Reused
/// storage.
class WaterShares {
  public:
    /// `weights`: a factor for each lamp, or none.
    void find(const WaterOptics& optics, const ScatteringTables& tables,
              const WaterSegment& segment, std::span<const double> weights, const PathState& state);

    /// By three random numbers, 0..1, on the segment of this `length`; none where nothing is lit.
    /// Once after each `find`, with the same tables.
    std::optional<ScatterPlace> choose(const ScatteringTables& tables, double length,
                                       double of_lamp, double of_phase, double of_angle);

  private:
    // One lamp's part.
    struct Share {
        // An interval of h = tan(psi / 2).
        struct HalfTangents {
            double begin = 0, end = 0;
        };

        std::size_t lamp = 0;
        double foot = 0, distance = 0;      // LampPassage
        std::array<HalfTangents, 2> parts;  // outside the lamp's sphere and within its beam
        std::size_t part_count = 0;
        double mass = 0;               // of the weighted phase functions on them
        std::size_t first_masses = 0;  // of masses_
        // Of a sun, whose mass is that of the weighted phase functions at its one angle:
        bool parallel = false;
        ParallelStretch stretch;
        LampPassage passage;
    };
    // HalfTangentDensity::mass_to at both ends of a part.
    struct Masses {
        double from = 0, to = 0;
    };

    Share parallel_share(const WaterOptics& optics, const ScatteringTables& tables,
                         const WaterSegment& segment, std::size_t lamp, const LampPassage& passage,
                         const Interval& lit);
    static ScatterPlace place_in_parallel(const Share& share, double u);
    std::optional<ScatterPlace> place_around(const ScatteringTables& tables, const Share& share,
                                             double length, double of_phase, double of_angle);

    std::vector<double> phase_weights_;  // of the phase functions on this segment
    std::vector<Share> shares_;
    std::vector<Masses> masses_;  // by share, part and phase function
    std::vector<double> cumulative_, phase_;
};

}  // namespace uw
