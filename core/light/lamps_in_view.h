#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/light/emission.h"
#include "core/light/integrator.h"
#include "core/light/lamp.h"
#include "core/light/lamp_patch.h"
#include "core/light/medium.h"

namespace uw {

/// Points that represent a luminous surface, each the same area of it.
struct LampPoints {
    std::vector<Point3> positions;
    double patch_radius = 0;  // squared_offset
};

/// The luminous surface of a lamp with an extent, in the world.
struct LampSurface {
    Lamp lamp;  // all of it, at its centre
    LampFrame frame;
    LampPoints emitters;  // as in LitScene::emitters
    LampPoints many;      // enough of them to be as accurate as the surface

    /// Whether the in-scatter from the emitters on `ray` may differ from that of the surface, as it
    /// does only where the ray passes it closely.
    bool is_passed_by(const Ray& ray) const;
    /// The distance at which `ray` crosses the surface, or passes the centre of a sphere that it
    /// hits [m]; infinite if it misses.
    double crossing(const Ray& ray) const;
    /// Its radiance towards the origin of a ray that crosses it, for 1 W/sr on the axis [1/m^2]:
    /// the relative intensity over the projected area; 0 for a surface that is viewed edge-on.
    double radiance_towards(const Ray& ray) const;
};

/// The integral of each phase function p of a medium over the scattering angle, int_0^psi p dpsi.
/// As ds / R^2 = dpsi / D on a ray at the distance D from a point, D times the in-scatter from that
/// point has this integral if nothing else varies along the ray (physics section 5; the change of
/// variable of equiangular sampling, Kulla and Fajardo 2012). Tabulated over tan(psi / 2).
class PhaseIntegrals {
  public:
    explicit PhaseIntegrals(const Medium& medium);

    std::size_t phase_count() const { return phases_; }
    /// Adds `factor` times the integrals up to psi to `sums`, one per phase function;
    /// `half_tangent` is tan(psi / 2) >= 0.
    void add(double half_tangent, double factor, std::span<double> sums) const;

  private:
    std::size_t phases_;
    std::vector<double> integrals_;  // [knot * phases + m]
};

/// The factor that corrects the in-scatter from the emitters of a lamp with an extent to that from
/// the lamp's surface, so that no pattern of points is visible. Thread safe.
class LampEvenness {
  public:
    /// What `scene` refers to must outlive this object.
    explicit LampEvenness(const LitScene& scene);

    /// The ratio, per band, of the in-scatter from the surface of the lamp with this index to that
    /// from its emitters, on an interval of a ray: 1 for a lamp without an extent, and for rays
    /// that do not pass the surface closely. It ignores shadows, profiles and attenuation, and
    /// takes the water from where the ray is nearest to the lamp.
    Spectrum of(std::size_t lamp, const Ray& ray, const Interval& interval) const;

    /// Finds that ratio for each interval of a ray between `begin` and the ascending `distances`.
    void find(std::size_t lamp, const Ray& ray, double begin, std::span<const double> distances,
              std::vector<Spectrum>& result) const;

  private:
    // The mean over the points of the integral of each phase function over R^2 along an interval
    // [1/(m sr)].
    void integrate(const LampPoints& points, const Ray& ray, const Interval& interval,
                   std::span<double> scattered) const;
    Spectrum one() const;

    LitScene scene_;
    std::optional<PhaseIntegrals> integrals_;  // none: no lamp of the scene has an extent
};

/// A lamp whose luminous surface, or emissive volume, a ray crosses.
struct SeenLamp {
    std::size_t lamp = 0;    // its index in the scene
    double distance = 0;     // along the ray; for a volume, the mean over its emission [m]
    Spectrum radiance;       // before attenuation by the water [W m^-2 sr^-1]
    Spectrum arriving;       // the radiance at the ray's origin
    bool is_volume = false;  // not a surface
};

/// The light of lamps that the camera sees directly. A luminous surface adds its light to that from
/// behind it: it casts no shadow and occludes nothing. The light of a volume is the integral of its
/// emission along the ray, int emission e^-tau ds. Thread safe.
class LampsInView {
  public:
    /// `scene` must outlive this object.
    explicit LampsInView(const LitScene& scene) : scene_(scene), attenuation_(*scene.medium) {}

    /// Appends the lamps that `ray` crosses before the surface at `max_distance` [m], one that lies
    /// on that surface included.
    void append(const Ray& ray, double max_distance, std::vector<SeenLamp>& visible) const;

  private:
    void append_volume(const SceneEmission& emissive, const Ray& ray, double max_distance,
                       std::vector<SeenLamp>& visible) const;

    LitScene scene_;
    AttenuationTable attenuation_;
};

}  // namespace uw
