#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/paths/lamp_radiance_table.h"
#include "core/paths/medium_radiance_cache.h"
#include "core/paths/next_event_estimator.h"
#include "core/paths/path_segment.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// What guides look up; what is referred to outlives them.
struct GuidingTables {
    const WaterOptics& optics;
    const ScatteringTables& scattering;
    const NextEventEstimator& lamps;
    // b by band, all phase functions together: of the uniform water, and of constituents per unit.
    Spectrum uniform_scattering;
    std::vector<Spectrum> constituents_scattering;

    MediumRadianceCache particles;

    GuidingTables(const WaterOptics& of_optics, const ScatteringTables& of_scattering,
                  const NextEventEstimator& of_lamps);
};

/// How much light of the lamps may arrive at a point, and from where: by the field of a lamp in
/// infinite water (LampRadianceTable), at the optical depth of the straight way to it. It guides
/// random paths, and nothing but their variance depends on it. All values are means over the bands
/// with the weights given to `find`. Reused storage.
class GuidingDistribution {
  public:
    struct Guide {
        std::size_t lamp = 0;
        Vector3 direction{0, 0, 1};  // to the lamp
        double radius = 0;           // its distance [m]
        double irradiance = 0;       // expected, for a surface that faces it [W m^-2]
        double intensity = 0;        // whose field it is in: [W sr^-1]
        double attenuation = 0;      // mean, on the way [1/m]
        double albedo = 0;
        double scale = 0;  // of the radiance: intensity times squared depth over squared distance
        // The irradiance of a sun's light that the water scatters once, by any angle, which has the
        // shape of the phase function next to the sun's direction. 0 for all other lamps.
        double scattered_once = 0;
        LampRadianceTable::Place place;
    };

    /// At the point `x`; `weights` by band.
    void find(const GuidingTables& tables, const Point3& x, const Spectrum& weights);
    std::span<const Guide> all() const { return guides_; }

    /// The light that arrives from `direction`, and its part that was scattered more than once
    /// [W m^-2 sr^-1].
    double radiance(const Vector3& direction) const;
    double multiple(const Vector3& direction) const;
    /// The mean of the light over the phase function around `direction`, at another point, near by.
    double source(const Point3& y, const Vector3& direction) const;

  private:
    const GuidingTables* tables_ = nullptr;
    std::vector<Guide> guides_;
    std::vector<double> column_;
};

/// The light of lamps that a surface, as it is hit, reflects evenly to all sides, by the same
/// field; at least as much as one that faces them a little: the mean over the bands with `weights`
/// [W m^-2 sr^-1].
double estimated_reflection(const GuidingTables& tables, const SurfaceHit& hit,
                            const Spectrum& weights);

}  // namespace uw
