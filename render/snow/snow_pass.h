#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "core/base/ray.h"
#include "core/image/film.h"
#include "core/image/image_quantity.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"
#include "core/passes/pass.h"
#include "core/scene/scene_desc.h"
#include "core/scene/water_desc.h"
#include "render/snow/snow_image.h"
#include "render/snow/snow_model.h"

namespace uw {

/// A camera at one time of an exposure.
struct ExposureView {
    Camera camera;
    double time = 0;  // relative to the middle of the exposure [s]
    /// Maps a point to where the camera in the middle sees it as this one does.
    Affine middle_from_moment;
};

/// Returns the camera of an image's scene in the middle of the exposure, when the shutter opens and
/// when it closes. Without a shutter (RenderDesc::shutter), it is the middle alone; times that the
/// camera's trajectory does not include are left out. `middle` [s] comes first.
std::vector<ExposureView> exposure_views(const SceneDesc& scene, double middle);

/// A convex body that contains all points that an image sees up to a distance, at any time while
/// the shutter is open and through any point of the lens's aperture. Points that drift are included
/// where they are in the middle of the exposure.
class ViewHull {
  public:
    /// `max_distance` [m] along rays in water; `drift` [m/s].
    ViewHull(const std::vector<ExposureView>& views, double max_distance, const Vector3& drift);

    /// Whether a sphere may be visible; false only if it is not.
    bool may_see(const Point3& centre, double radius) const {
        for (const Plane& plane : planes_)
            if (glm::dot(plane.normal, from_origin(centre)) > plane.offset + radius) return false;
        return true;
    }
    /// The bounds of all visible points; empty if there are none.
    const Bounds& bounds() const { return bounds_; }

  private:
    struct Plane {
        Vector3 normal;  // points out of the body
        double offset;
    };
    std::vector<Plane> planes_;
    Bounds bounds_;
};

/// Computes the radiance of particles, which every emitter lights through the water.
class SnowLighting {
  public:
    /// `deep_shadows` may be empty: then columns are integrated. All arguments must outlive this
    /// object.
    SnowLighting(const LitScene& scene,
                 std::span<const std::shared_ptr<const DeepShadow>> deep_shadows)
        : scene_(scene), attenuation_(*scene.medium), deep_shadows_(deep_shadows) {}

    /// Sets `radiance` to the mean radiance at the camera of the disk of a white particle at `x`,
    /// at a `distance` [m] along `ray`, one value per band [W m^-2 sr^-1]. Thread safe.
    void radiance(const Point3& x, const Ray& ray, double distance,
                  std::span<double> radiance) const;

  private:
    LitScene scene_;
    AttenuationTable attenuation_;
    std::span<const std::shared_ptr<const DeepShadow>> deep_shadows_;
};

/// Draws the particles of an image; all references must outlive it.
struct SnowPlacing {
    const SnowModel& model;
    const SnowDesc& desc;
    double time = 0;  // the middle of the exposure [s]
    const std::vector<ExposureView>& views;
    const Surfaces& surfaces;
    const SnowLighting& lighting;
    const WaterVeil& veil;
    const SensorModel& sensor;

    /// Returns the splats of all particles that touch a pixel of `window` and are not behind a
    /// surface. Runs on all threads. Throws Interrupted.
    SnowSplats splats(const PixelWindow& window, const ProgressCallback& progress) const;
};

/// Renders marine snow: places the particles, and adds to each pixel the change that they make to
/// its light and, if requested, to its ground truth.
class SnowPass final : public Pass {
  public:
    explicit SnowPass(const SnowDesc& desc)
        : Pass(Stage::snow), in_ground_truth_(desc.in_ground_truth) {}

    void provide(LayerSupply& supply) const override;
    void begin(Rendering& rendering) override;
    void run(Rendering& rendering) override;

  private:
    void add_to(const RenderedPixel& pixel, const PixelRenderer& pixels) const;

    bool in_ground_truth_;
    std::optional<SnowLayer> layer_;  // of the image, from run on
};

}  // namespace uw
