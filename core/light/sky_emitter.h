#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/light/directional_emitter.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"
#include "core/light/sky_parts.h"

namespace uw {

/// A part of the sky: parallel light from its direction, for what takes no notice of its extent;
/// and a source that is sampled. Directions lead from the water towards the sky, in the world.
class SkyEmitter final : public DirectionalEmitter {
  public:
    /// `part`: its number in `parts`. `irradiance`: that of its direction in the water, as the
    /// axis intensity of its lamp [W/m^2].
    SkyEmitter(const Sunlight& sunlight, const LampPatch& patch,
               std::shared_ptr<const SkyParts> parts, std::size_t part,
               const Matrix3& world_from_sky, const Spectrum& irradiance);

    Point3 origin_on_patch(const Point3& x, const UnitPoint& place) const override;

    const SkyParts& parts() const { return *parts_; }
    const SkyParts::Part& part() const { return parts_->parts()[number_]; }
    Vector3 in_world(const Vector3& in_sky) const { return world_from_sky_ * in_sky; }
    Vector3 in_sky(const Vector3& in_world) const { return in_world * world_from_sky_; }

    /// Samples a direction of the part by two numbers in [0, 1), and its pdf [1/sr]
    /// (SkyParts::sample).
    Vector3 sample(double u, double v) const { return in_world(parts_->sample(part(), u, v)); }
    double pdf(const Vector3& towards) const { return parts_->pdf(part(), in_sky(towards)); }
    /// The radiance from one of its directions below the surface, for `lamp`, which may be brighter
    /// or fainter than the sky itself [W m^-2 sr^-1].
    Spectrum radiance(const Vector3& towards, const Lamp& lamp) const;
    /// The mean over its light of the cosine to a surface's normal, 0 for directions behind the
    /// surface.
    double mean_cosine(const Vector3& normal) const;

    /// The length of the way of the light from one of its directions to `x` [m].
    double length_to(const Point3& x, const Vector3& towards) const;
    /// The geometry of a ray through the light from one of its directions.
    LampPassage passage_of(const Ray& ray, const Vector3& towards) const;

  protected:
    bool equals(const Emitter& other) const override;

  private:
    std::shared_ptr<const SkyParts> parts_;
    std::size_t number_;
    Matrix3 world_from_sky_;
    Spectrum irradiance_;
};

/// Which of a scene's emitters are parts of the sky: by emitter, null for all others; empty if
/// there are none.
std::vector<const SkyEmitter*> sky_emitters(const std::vector<Lamp>& emitters);

/// Single scattering of the sky's light: phase functions averaged over the parts of the sky, rather
/// than taken at the direction that represents each. So no part shows as a spot of its own where
/// the water scatters forwards.
///
///     p_mean(d) = int L p(w, d) dw / int L dw over the directions w of a part,
///
/// with L the radiance in the water, as a sum over the part's cells. The phase functions are first
/// blurred by about the width of a cell, which leaves no pattern of cells and takes no light.
class SkyScattering {
  public:
    struct Workspace {
        std::vector<double> half_tangents, p;
    };

    /// What `scene` refers to must outlive this object.
    explicit SkyScattering(const LitScene& scene);

    /// Whether this emitter of the scene is a part of the sky.
    bool contains(std::size_t emitter) const { return !skies_.empty() && skies_[emitter]; }

    /// Finds the mean of each phase function for the light that an emitter sends to a ray with this
    /// direction [1/sr]. Returns a length of the way of that light to any depth, relative to that
    /// from the emitter's direction, which gives its mean attenuation
    /// (SkyParts::k_depth_of_transmittance). Precondition: the emitter is a part of the sky.
    double find(std::size_t emitter, const Vector3& direction, std::vector<double>& phase,
                Workspace& workspace) const;

  private:
    std::vector<const SkyEmitter*> skies_;
    std::vector<double> phase_fractions_;  // of the medium
    std::optional<PhaseTable> phases_;     // blurred; none without a sky
};

}  // namespace uw
