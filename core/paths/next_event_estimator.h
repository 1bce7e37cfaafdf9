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
#include "core/light/lamps_in_view.h"
#include "core/light/ray_panels.h"
#include "core/light/sky_emitter.h"
#include "core/paths/path_segment.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// The interval of a segment that a sun's parallel light illuminates. Distances are sampled in
/// proportion to the transmittance of uniform water, along the light and back along the segment.
class ParallelLightInterval {
  public:
    ParallelLightInterval() = default;
    /// `lit`: what the sun illuminates of the line; may be infinite only if the light travels along
    /// it. `attenuation`: of the water [1/m].
    ParallelLightInterval(const LampPassage& passage, const Interval& lit, double attenuation)
        : lit_(lit), rate_(attenuation * (1 + passage.slope)) {}

    /// int e^(-rate s) ds over the interval [m].
    double effective_length() const;
    /// The same interval for light of another direction.
    ParallelLightInterval with(const LampPassage& passage, double attenuation) const {
        return {passage, lit_, attenuation};
    }
    /// Samples a distance by a random number in [0, 1).
    double sample(double u) const;
    /// The pdf of the sampled distance [1/m].
    double pdf(double s) const;

  private:
    Interval lit_;
    double rate_ = 0;  // of e^(-rate s) [1/m]
};

/// A point on a segment where a lamp's light is scattered once, towards the segment's origin.
struct ScatterPlace {
    std::size_t lamp = 0;
    double s = 0;             // along the segment
    double half_tangent = 0;  // of the scattering angle
    double radius = 0;        // from the light's origin
    double pdf = 0;           // of the point [1/m], times Lamp::spread
    /// This is the direction towards the sky, if the light is the sky's; the pdf is then that of
    /// both [1/(m sr)], over the weight of multiple importance sampling.
    Vector3 towards_sky{0};
    bool is_any_sky = false;  // the direction may be one of any part of the sky, not of the lamp's
};

/// Chooses a lamp and a point on a segment for next-event estimation of in-scattered light:
/// equiangular sampling (Kulla and Fajardo 2012) weighted by the phase functions around a lamp, by
/// transmittance in a sun's light. Storage is reused.
class InScatterSampler {
  public:
    /// Weights the lamps and phase functions for a segment of a path.
    /// `skies`: as sky_emitters says.
    void prepare(const WaterOptics& optics, const ScatteringTables& tables,
                 std::span<const SkyEmitter* const> skies, const WaterSegment& segment,
                 const PathState& state);

    /// Samples by three random numbers in [0, 1) on the segment; none where nothing is lit. Light
    /// of the sky takes two more of `random`. May be called once after each `prepare`, with the
    /// same arguments.
    std::optional<ScatterPlace> sample(const ScatteringTables& tables,
                                       std::span<const SkyEmitter* const> skies,
                                       const WaterSegment& segment, double u_lamp, double u_phase,
                                       double u_angle, PathRandom& random);

  private:
    // A lamp that may be chosen.
    struct Candidate {
        // An interval of h = tan(psi / 2).
        struct HalfTangents {
            double begin = 0, end = 0;
        };

        std::size_t lamp = 0;
        double foot = 0, distance = 0;      // LampPassage
        std::array<HalfTangents, 2> parts;  // outside the lamp's sphere and within its beam
        std::size_t part_count = 0;
        double mass = 0;               // integral of the weighted phase functions over the parts
        std::size_t first_masses = 0;  // index into masses_
        // For a sun; its mass is that of the weighted phase functions at its one angle:
        bool parallel = false;
        ParallelLightInterval interval;
        double attenuation = 0;  // that of the interval [1/m]
        LampPassage passage;
    };
    // HalfTangentDensity::mass_to at both ends of a part.
    struct Masses {
        double from = 0, to = 0;
    };

    Candidate parallel_candidate(const WaterOptics& optics, const ScatteringTables& tables,
                                 const WaterSegment& segment, std::size_t lamp,
                                 const LampPassage& passage, const Interval& lit);
    // Samples a direction of the sky by multiple importance sampling (Veach 1997): a direction of
    // the lamp's part of the sky or, where the segment leads towards Snell's window, one of all of
    // it by the phase functions. The weights depend on the direction alone; so each of the two
    // finds its fraction of all light, whichever part the path sees.
    std::optional<ScatterPlace> sample_sky(const ScatteringTables& tables, const SkyEmitter& sky,
                                           const Candidate& candidate, const Ray& ray,
                                           double u_phase, double u_distance,
                                           PathRandom& random) const;
    static ScatterPlace sample_parallel(const Candidate& candidate, double u);
    std::optional<ScatterPlace> sample_around(const ScatteringTables& tables,
                                              const Candidate& candidate, double length,
                                              double u_phase, double u_angle);

    std::vector<double> phase_weights_;  // of the phase functions on this segment
    std::vector<Candidate> candidates_;
    std::vector<Masses> masses_;  // by candidate, part and phase function
    std::vector<double> cumulative_, phase_;
};

/// Memory in which NextEventEstimator works; what it holds between two calls does not matter.
struct NextEventScratch {
    /// A lamp that illuminates the surface.
    struct DirectCandidate {
        std::size_t lamp = 0;
        double radius = 0, geometry = 0;  // of the sky, by the direction of its part
    };

    InScatterSampler in_scatter;
    std::vector<DirectCandidate> direct;
    std::vector<double> cumulative;
    std::vector<double> column, p;
    WaterPoint point;
    Spectrum radiance, brdf, sky_radiance;
};

/// Next-event estimation: estimates the light of lamps that arrives along a segment after a single
/// event, in-scattered by the water on the segment or reflected by the surface at its end. Thread
/// safe.
class NextEventEstimator {
  public:
    /// `deep_shadows`: tabulated columns to the lamps, one per lamp; if empty, columns are exact.
    /// `emitters`: the lamps' indices among the emitters of the whole scene. What is referred to
    /// must outlive this object.
    NextEventEstimator(const WaterOptics& optics, const ScatteringTables& tables,
                       std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                       std::vector<std::size_t> emitters);

    /// Estimates the in-scattered light of one lamp, chosen in proportion to its expected
    /// contribution,
    ///
    ///     int I b p e^-tau / R^2 ds,
    ///
    /// by equiangular sampling (Kulla and Fajardo 2012): with the scattering angle psi and the
    /// lamp's distance D from the line, ds / R^2 = dpsi / D. Sampling psi in proportion to the
    /// phase functions makes the forward peak constant, too. For a sun, distances are sampled by
    /// transmittance, and for a part of the sky a direction first. Uses three random numbers, and
    /// for the sky two more.
    void estimate_in_scatter(const WaterSegment& segment, const PathState& state,
                             PathRandom& random, ContributionSink& sink,
                             NextEventScratch& scratch) const;
    /// Estimates the light of one lamp, chosen in proportion to its expected contribution, that the
    /// surface at the end reflects, and adds what the surface emits. `transmittance`: that of the
    /// segment. Uses one random number, and for the sky two more. Precondition: segment.has_hit.
    void estimate_direct_light(const WaterSegment& segment, const Spectrum& transmittance,
                               const PathState& state, PathRandom& random, ContributionSink& sink,
                               NextEventScratch& scratch) const;

    /// Multiplies light from `origin` by what glass on its way to `x` leaves of it.
    void dim_by_glass(const Point3& origin, const Point3& x, std::span<double> radiance) const;
    /// The columns of the constituents between a lamp and a point [unit m].
    void column_to_lamp(std::size_t lamp, const Point3& x, std::span<double> column) const;

  private:
    // The columns between the sky, in a direction near that of an emitter, and `x`.
    void column_to_sky(std::size_t lamp, const Point3& x, const Point3& origin,
                       std::span<double> column) const;

    const WaterOptics& optics_;
    const ScatteringTables& tables_;
    std::vector<const SkyEmitter*> skies_;
    LampEvenness evenness_;
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows_;
    std::vector<std::size_t> emitters_;
};

}  // namespace uw
