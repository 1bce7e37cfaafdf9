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

/// Points that stand for a luminous surface, each for as much of it.
struct LampPoints {
    std::vector<Point3> positions;
    double patch_radius = 0;  // distance_aside
};

/// The luminous surface of a lamp with an extent, in the world.
struct LampSurface {
    Lamp lamp;  // all of it, at its centre
    LampFrame frame;
    LampPoints emitters;  // as in LitScene::emitters
    LampPoints many;      // so many that they are as good as the surface

    /// Whether the light of the emitters that is scattered on `ray` may differ from that of the
    /// surface: only where the ray passes it closely.
    bool is_passed_by(const Ray& ray) const;
    /// Where `ray` crosses the surface, or passes the centre of a sphere [m]; infinite if it does
    /// not.
    double crossing(const Ray& ray) const;
    /// Its radiance towards the origin of a ray that crosses it, for 1 W/sr on the axis [1/m^2]:
    /// relative intensity over the area that is seen. 0 for a surface that is seen edge-on.
    double radiance_towards(const Ray& ray) const;
};

/// The integral of each phase function p of a medium over the scattering angle, int_0^psi p dpsi:
/// as ds / R^2 = dpsi / D on a ray at the distance D from a point, it is what the point scatters
/// there, if nothing else changes along the ray (physics section 5). Tabulated over tan(psi / 2).
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

/// By what the light that the emitters of a lamp with an extent scatter on a ray is corrected, so
/// that it is that of the lamp's surface, without a pattern of points. Thread safe.
class LampEvenness {
  public:
    /// What `scene` refers to must outlive this object.
    explicit LampEvenness(const LitScene& scene);

    /// The light that the surface of the lamp with this index scatters on a stretch of a ray, in
    /// proportion to that of its emitters, per band: 1 for a lamp without an extent, and but for
    /// rays that pass the surface closely. Shadows, profiles and attenuation are left out; the
    /// water is that where the ray is nearest to the lamp.
    Spectrum of(std::size_t lamp, const Ray& ray, const Interval& stretch) const;

    /// Finds the same for each stretch of a ray between `begin` and the ascending `distances`.
    void find(std::size_t lamp, const Ray& ray, double begin, std::span<const double> distances,
              std::vector<Spectrum>& result) const;

  private:
    // The mean over the points of the integral of each phase function over R^2 along a stretch
    // [1/(m sr)].
    void integrate(const LampPoints& points, const Ray& ray, const Interval& stretch,
                   std::span<double> scattered) const;
    Spectrum one() const;

    LitScene scene_;
    std::optional<PhaseIntegrals> integrals_;  // none: no lamp of the scene has an extent
};

/// A lamp whose luminous surface, or glowing volume, a ray crosses.
struct SeenLamp {
    std::size_t lamp = 0;    // its index in the scene
    double distance = 0;     // along the ray, of a volume's light in the mean [m]
    Spectrum radiance;       // before the water dims it [W m^-2 sr^-1]
    Spectrum arriving;       // what of that arrives at the ray's origin
    bool is_volume = false;  // not a surface
};

/// What the camera sees of lamps themselves. A luminous surface adds its light to what is behind
/// it: as it throws no shadow, it hides nothing. A volume's light is the integral of what it gives
/// off along the ray, int emission e^-tau ds. Thread safe.
class LampsInView {
  public:
    /// `scene` must outlive this object.
    explicit LampsInView(const LitScene& scene) : scene_(scene), attenuation_(*scene.medium) {}

    /// Appends the lamps that `ray` crosses up to the surface at `reach` [m]; one that lies on that
    /// surface is before it.
    void append(const Ray& ray, double reach, std::vector<SeenLamp>& seen) const;

  private:
    void append_volume(const SceneEmission& emissive, const Ray& ray, double reach,
                       std::vector<SeenLamp>& seen) const;

    LitScene scene_;
    AttenuationTable attenuation_;
};

}  // namespace uw
