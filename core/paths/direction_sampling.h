#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/integrators/lit_scene.h"
#include "core/paths/path_random.h"
#include "core/paths/scattering_tables.h"
#include "core/paths/water_segment.h"

namespace uw {

/// Draws the directions in which paths go on. At every vertex it mixes the density of the
/// scattering or reflection with lobes around the directions to the lamps, shaped like the light
/// that the water scatters around a lamp: single-scattered radiance grows as 1/psi towards it,
/// which no phase function's density follows, so that the variance would be infinite without them.
/// Thread safe.
class DirectionSampling {
  public:
    DirectionSampling(const WaterOptics& optics, const ScatteringTables& tables);

    /// Scatters a path that travels along `direction` at `x`. `point`: with its scattering
    /// coefficients. Multiplies `throughput` by sum_m b_m p_m over the density. Uses three random
    /// numbers.
    Vector3 scatter(const Point3& x, const Vector3& direction, const WaterPoint& point,
                    PathRandom& random, Spectrum& throughput) const;

    /// Reflects the path of `segment` at its hit. Multiplies `throughput` by BRDF times cosine over
    /// the density. Uses three random numbers. Empty if nothing is reflected that way.
    std::optional<Vector3> reflect(const WaterSegment& segment, PathRandom& random,
                                   Spectrum& throughput) const;

    /// The single-scattered light that fills the water at `x` in each band, up to the scattering
    /// coefficient and a factor of the order of 1: sum_j I_j e^(-c R_j) / R_j [W sr^-1 m^-1].
    void glow(const Point3& x, std::span<double> values) const;

  private:
    struct Lobes;

    void find_lobes(const Point3& x, const Spectrum& throughput, const Vector3* normal,
                    Lobes& lobes) const;
    double lobe_density(const Lobes& lobes, const Vector3& direction) const;
    Vector3 sample_lobe(const Lobes& lobes, double u, double v, double azimuth) const;

    const WaterOptics& optics_;
    const ScatteringTables& tables_;
};

}  // namespace uw
