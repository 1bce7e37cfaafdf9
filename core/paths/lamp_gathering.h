#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/base/ray.h"
#include "core/light/integrator.h"
#include "core/light/ray_panels.h"
#include "core/paths/path_segment.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// Where on a line the parallel light of a sun is scattered along it: distances drawn as its way
/// through uniform water attenuates it.
class ParallelStretch {
  public:
    ParallelStretch() = default;
    /// `lit`: what the sun illuminates of the line; may be infinite only if the light falls along
    /// it. `attenuation`: of the water [1/m].
    ParallelStretch(const LampPassage& passage, const Interval& lit, double attenuation)
        : lit_(lit), rate_(attenuation * (1 + passage.slope)) {}

    /// The length over which light as bright as at the beginning would be scattered as much [m].
    double effective_length() const;
    /// The distance up to which a `share` (0..1) of all lie.
    double draw(double share) const;
    /// The density of what is drawn at `s` [1/m].
    double density(double s) const;

  private:
    Interval lit_;
    double rate_ = 0;  // of e^(-rate s) [1/m]
};

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
        // Members for a sun, whose mass is that of the weighted phase functions at its one angle:
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

/// Estimates the light of lamps that arrives along a segment after a single event: scattered by
/// the water on it, or reflected by the surface at its end. Thread safe.
class LampGathering {
  public:
    /// `deep_shadows`: columns to the lamps, one per lamp; empty: they are exact. The other
    /// references must outlive this object.
    LampGathering(const WaterOptics& optics, const ScatteringTables& tables,
                  std::vector<std::shared_ptr<const DeepShadow>> deep_shadows);

    /// The water's: int I b p e^-tau / R^2 ds for a lamp chosen by its share, at a point chosen by
    /// its scattering angle psi, in which 1/R^2 and the forward peak are flat: ds / R^2 = dpsi / D
    /// with D the lamp's distance from the line; a sun's at one chosen by its attenuation
    /// (ParallelStretch). Uses three random numbers. `weights`: a factor for
    /// each lamp, or none; lamps whose factor is 0 are not chosen.
    void gather_from_water(const WaterSegment& segment, std::span<const double> weights,
                           const PathState& state, PathRandom& random, PathTerms& terms) const;
    /// The surface's, for a lamp chosen by its share; `transmittance` is that of the segment. Uses
    /// one random number. Returns what would arrive of it, and of what the surface emits, through
    /// clear water, roughly: the mean of the bands [W m^-2 sr^-1]. Precondition: segment.has_hit.
    double gather_from_surface(const WaterSegment& segment, const Spectrum& transmittance,
                               const PathState& state, PathRandom& random, PathTerms& terms) const;

  private:
    struct Workspace;

    void column_to_lamp(std::size_t lamp, const Point3& x, std::span<double> column) const;

    const WaterOptics& optics_;
    const ScatteringTables& tables_;
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows_;
};

}  // namespace uw
