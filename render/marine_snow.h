#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/base/ray.h"
#include "core/image/film.h"
#include "core/image/image_quantity.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"
#include "core/passes/marine_snow.h"
#include "core/passes/pass.h"
#include "core/passes/snow_image.h"
#include "core/scene/scene_desc.h"
#include "core/scene/water_desc.h"

namespace uw {

/// `medium` holds the snow's mean. Throws as without_snow.
std::shared_ptr<const SnowModel> make_snow_model(const SnowDesc& desc, const Camera& camera,
                                                 const Medium& medium);

/// A camera at one moment of an exposure.
struct ExposureView {
    Camera camera;
    double time = 0;            // from the middle of the exposure [s]
    Affine middle_from_moment;  // takes what it sees to where that is seen in the middle
};

/// The camera of an image's scene when the shutter opens, in the middle and when it closes; in the
/// middle alone without a shutter (RenderDesc::shutter), and without the ends that its trajectory
/// does not reach. The `middle` [s] is the first.
std::vector<ExposureView> exposure_views(const SceneDesc& scene, double middle);

/// A convex body around all that an image sees up to a distance while its shutter is open, through
/// all of the lens's aperture: of what drifts, where it is in the middle of the exposure.
class ViewHull {
  public:
    /// `reach` [m] along rays in water; `drift` [m/s].
    ViewHull(const std::vector<ExposureView>& views, double reach, const Vector3& drift);

    /// Whether a sphere may be seen; false only if it is not.
    bool may_see(const Point3& centre, double radius) const {
        for (const Plane& plane : planes_)
            if (glm::dot(plane.normal, from_origin(centre)) > plane.offset + radius) return false;
        return true;
    }
    /// Around all that is seen; empty if nothing is.
    const Bounds& bounds() const { return bounds_; }

  private:
    struct Plane {
        Vector3 normal;  // out of the body
        double offset;
    };
    std::vector<Plane> planes_;
    Bounds bounds_;
};

/// The light of particles as a camera sees it, lit by every emitter as the water around them is.
class SnowLighting {
  public:
    /// The light splatted may be empty: then columns are integrated. All arguments outlive this.
    SnowLighting(const LitScene& scene,
                 std::span<const std::shared_ptr<const DeepShadow>> deep_shadows)
        : scene_(scene), attenuation_(*scene.medium), deep_shadows_(deep_shadows) {}

    /// The mean radiance of the disk of a white particle at `x`, seen along `ray` at a `distance`
    /// [m], after the water on the way, into one value per band [W m^-2 sr^-1]. Thread safe.
    void radiance(const Point3& x, const Ray& ray, double distance,
                  std::span<double> radiance) const;

  private:
    LitScene scene_;
    AttenuationTable attenuation_;
    std::span<const std::shared_ptr<const DeepShadow>> deep_shadows_;
};

/// What placing the particles of an image needs; all references outlive it.
struct SnowPlacing {
    const SnowModel& model;
    const SnowDesc& desc;
    double time = 0;  // the middle of the exposure [s]
    const std::vector<ExposureView>& views;
    const Surfaces& surfaces;
    const SnowLighting& lighting;
    const WaterVeil& veil;
    const SensorModel& sensor;

    /// Every particle that touches a pixel of `window` and is not behind a surface, on all threads.
    /// Throws Interrupted.
    SnowSplats splats(const PixelWindow& window, const ProgressCallback& progress) const;
};

/// Marine snow: places the particles, and adds to each pixel what they change in its light, and in
/// its ground truth if that is wanted.
class SnowPass final : public Pass {
  public:
    explicit SnowPass(const SnowDesc& desc)
        : Pass("snow"), in_ground_truth_(desc.in_ground_truth) {}

    void provide(LayerSupply& supply) const override;
    void begin(Rendering& rendering) override;
    void run(Rendering& rendering) override;

  private:
    void add_to(const RenderedPixel& pixel, const PixelRenderer& pixels) const;

    bool in_ground_truth_;
    std::optional<SnowLayer> layer_;  // of the image, from run on
};

}  // namespace uw
