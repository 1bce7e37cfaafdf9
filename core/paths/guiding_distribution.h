#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/paths/emission_sampler.h"
#include "core/paths/lamp_radiance_table.h"
#include "core/paths/medium_radiance_cache.h"
#include "core/paths/next_event_estimator.h"
#include "core/paths/path_segment.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// The tables that guiding distributions look up. What they refer to must outlive them.
struct GuidingTables {
    const WaterOptics& optics;
    const ScatteringTables& scattering;
    const NextEventEstimator& lamps;
    const LampRadianceTable& lamp_radiance;  // made once, so that look-ups take no lock
    const EmissionSampler& emission;
    // b by band, summed over the phase functions: of the uniform water, and of the constituents per
    // unit.
    Spectrum uniform_scattering;
    std::vector<Spectrum> constituents_scattering;

    MediumRadianceCache particles;

    GuidingTables(const WaterOptics& of_optics, const ScatteringTables& of_scattering,
                  const NextEventEstimator& of_lamps, const EmissionSampler& of_emission);

    /// Where the light of a lamp that reaches `x` comes from, what its irradiance is divided by at
    /// the distance `radius`, the columns on its way [unit m] and the fraction of its light that
    /// sets out. Those of an emissive volume that paths meet are its sphere's, and what leaves that
    /// crosses the uniform water alone.
    Point3 origin(const Lamp& lamp, const Point3& x) const;
    double spread(const Lamp& lamp, double radius) const;
    void column(std::size_t lamp, const Point3& x, std::span<double> column) const;
    double fraction(const Lamp& lamp) const;
};

/// Estimates the radiance of the lamps at a point by direction (path guiding: Vorba and Krivanek
/// 2016, Herholz et al. 2019): that of a point lamp in infinite water (LampRadianceTable) at the
/// optical depth of the straight line to it. Only the variance of paths depends on it. All values
/// are means over the bands with the weights given to `find`. Storage is reused.
class GuidingDistribution {
  public:
    struct Guide {
        std::size_t lamp = 0;
        Vector3 direction{0, 0, 1};  // to the lamp
        double radius = 0;           // its distance [m]
        double irradiance = 0;       // expected, on a surface that faces the lamp [W m^-2]
        double intensity = 0;        // of the lamp whose radiance is looked up [W sr^-1]
        double attenuation = 0;      // mean, along the line to the lamp [1/m]
        double albedo = 0;
        double scale = 0;  // of the radiance: intensity times (depth / distance)^2
        // The irradiance by a sun's light that the water scatters once, by any angle. Its radiance
        // has the shape of the phase function around the sun's direction. 0 for all other lamps.
        double scattered_once = 0;
        // The intensity of an emissive volume that paths meet: its direct light is part of what
        // they find there. 0 for all other lamps.
        double emitted = 0;
        LampRadianceTable::Place place;
    };

    /// Prepares the distribution at the point `x`; `weights` by band.
    void find(const GuidingTables& tables, const Point3& x, const Spectrum& weights);
    std::span<const Guide> all() const { return guides_; }

    /// A direction in about the shape of the radiance. Precondition: there are guides.
    Vector3 sample(double u, double azimuth) const;
    /// The radiance that arrives from a direction [W m^-2 sr^-1], and the density of `sample` there
    /// [1/sr], 0 without guides.
    struct Towards {
        double radiance = 0, pdf = 0;
    };
    Towards towards(const Vector3& direction) const;
    /// The part of the radiance that was scattered more than once, or once by the light of an
    /// emissive volume: what next-event estimation does not find [W m^-2 sr^-1].
    double multiple(const Vector3& direction) const;
    /// The mean of the radiance at a point `y` near by over the phase function around `direction`:
    /// the source radiance per scattering coefficient.
    double source(const Point3& y, const Vector3& direction) const;

  private:
    const GuidingTables* tables_ = nullptr;
    std::vector<Guide> guides_;
    std::vector<double> cumulative_;  // of their irradiances
    std::vector<double> column_;
};

/// Estimates the radiance that a diffuse surface reflects of the light of lamps, by the same
/// tables: the mean over the bands with `weights` [W m^-2 sr^-1]. Bounded below: a surface that
/// faces away from the lamps may still be lit by the water. `column`: scratch memory.
double estimated_reflection(const GuidingTables& tables, const SurfaceHit& hit,
                            const Spectrum& weights, std::vector<double>& column);

}  // namespace uw
