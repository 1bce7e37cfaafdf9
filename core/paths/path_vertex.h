#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/surface_reflection.h"
#include "core/light/ray_panels.h"
#include "core/paths/path_segment.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// How much light of the lamps the water around a point may hold: guides random paths, and nothing
/// but their variance depends on it. Thread safe.
class LampGlow {
  public:
    /// Both must outlive this object.
    LampGlow(const WaterOptics& optics, const ScatteringTables& tables)
        : optics_(optics), tables_(tables) {}

    /// I e^(-c R) / R of a lamp, with c of the uniform water, summed over the bands with these
    /// weights [W sr^-1 m^-1]; of a sun, E e^(-c R) over the least c.
    double of_lamp(std::size_t lamp, const Point3& x, const Spectrum& weights) const;
    /// Along the ray with this `passage` of a lamp, at the point `x` at `s`: I / R times
    /// ScatteringTables::spread_glow, relative to the lamp's intensity, and R. With e^(-c R) and b,
    /// it is roughly the radiance that is scattered once and, at `x`, once more back along the
    /// ray, per metre and b.
    struct Spread {
        double relative = 0, radius = 0;
    };
    Spread spread(std::size_t lamp, const LampPassage& passage, double s, const Point3& x) const;

  private:
    double clearest() const;

    const WaterOptics& optics_;
    const ScatteringTables& tables_;
};

/// A direction drawn at a vertex, and its density over directions [1/sr].
struct DrawnDirection {
    Vector3 direction{0, 0, 1};
    double density = 0;
};

/// A direction drawn around that to one lamp; `density` includes the lamp's probability.
struct DrawnLobe {
    std::size_t lamp = 0;
    Vector3 direction{0, 0, 1};
    double density = 0;
};

/// What vertices look up; all of it outlives them.
struct VertexTables {
    const WaterOptics* optics = nullptr;
    const ScatteringTables* scattering = nullptr;
    const LampGlow* glow = nullptr;
};

/// The direction in which a path goes on that is scattered by the phase functions alone, where it
/// travels along `direction`. Multiplies `throughput`, by band, by the scattering coefficients over
/// the probability of what was drawn. Uses three random numbers; empty if nothing scatters.
std::optional<Vector3> scatter_plainly(const ScatteringTables& tables, const WaterPoint& point,
                                       const Vector3& direction, PathRandom& random,
                                       std::span<double> throughput);

/// Where a path from the camera turns: scattered by the water or reflected by a surface. Directions
/// are drawn in two ways. Its own, in proportion to the phase function or BRDF, go on with the
/// path. Lobes around the directions to the lamps, of the shape of the light that the water
/// scatters around a lamp, catch what a path's next segment would rarely hit: single-scattered
/// radiance grows as 1/psi towards a lamp, and the variance of directions drawn without them is
/// infinite. Reused storage.
class PathVertex {
  public:
    /// The path travels along `direction` and is scattered at `x`; `point` has the scattering
    /// coefficients there and must stay valid. `throughput` weighs the bands.
    void scatter(const VertexTables& tables, const Point3& x, const Vector3& direction,
                 const WaterPoint& point, const Spectrum& throughput);
    /// The path of `segment`, which must stay valid, is reflected by the surface at its end.
    void reflect(const VertexTables& tables, const WaterSegment& segment,
                 const Spectrum& throughput);

    const Point3& position() const { return x_; }

    /// Each uses three random numbers; empty if there is nothing to draw, or it does not lead into
    /// the water.
    std::optional<DrawnDirection> draw(PathRandom& random) const;
    std::optional<DrawnLobe> draw_lobe(PathRandom& random) const;

    /// The densities with which `draw` and, for each lamp of the scene, `draw_lobe` would have
    /// drawn `direction` [1/sr].
    double density(const Vector3& direction) const;
    void lobe_densities(const Vector3& direction, std::vector<double>& densities) const;

    /// How much light of lamps that the water has scattered more than once may arrive from
    /// `direction`, summed over the bands with the throughput as weights [W m^-2 sr^-1]. Guides
    /// paths, and nothing but their variance depends on it.
    double expected_light(const Vector3& direction) const;

    /// sum_m b_m p_m, or BRDF times cosine, towards `direction` [1/m/sr, 1/sr].
    void respond(const Vector3& direction, Spectrum& values) const;

  private:
    struct Lobe {
        std::size_t lamp;
        Vector3 direction;
        double glow;   // LampGlow times b
        double again;  // probability to be scattered once more before the lamp, roughly
    };

    void find_lobes(const Spectrum& throughput);
    double scattering_around() const;

    VertexTables tables_;
    Point3 x_;
    Vector3 incoming_{0, 0, 1};              // of the path, away from the camera
    const WaterPoint* point_ = nullptr;      // of a scattering
    const WaterSegment* segment_ = nullptr;  // of a reflection
    std::optional<SurfaceSample> sample_;
    std::optional<SurfaceReflection> reflection_;
    std::vector<double> phase_cumulative_;
    std::vector<Lobe> lobes_;
    std::vector<double> lobe_cumulative_;
};

}  // namespace uw
