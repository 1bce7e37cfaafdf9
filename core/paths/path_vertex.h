#pragma once

#include <optional>
#include <vector>

#include "core/paths/lamp_glow.h"
#include "core/paths/path_random.h"
#include "core/paths/scattering_tables.h"
#include "core/paths/water_segment.h"
#include "core/surfaces/surface_reflection.h"

namespace uw {

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
