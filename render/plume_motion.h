#pragma once

#include <optional>
#include <vector>

#include "camera/camera.h"
#include "core/light/medium.h"
#include "core/passes/pixel_view.h"
#include "media/volumes/volume_velocity.h"
#include "render/assembled_scene.h"

namespace uw {

/// Finds where what drifts with a scene's volumes is in the image of the next frame. Where volumes
/// overlap, their velocities are weighted by their attenuation there.
class PlumeMotion final : public PlumeMatcher {
  public:
    /// Reads the velocities of the volumes that have them. `next` is the camera of the next frame,
    /// `seconds` later. `scene` must outlive this object. Throws as VolumeVelocity.
    PlumeMotion(const AssembledScene& scene, Camera next, double seconds);

    std::optional<PointMatch> match(const Point3& point) const override;

  private:
    struct Moving {
        const LoadedVolume* volume;
        VolumeVelocity velocity;
    };
    double attenuation_at(const LoadedVolume& volume, const Point3& point) const;

    std::vector<Moving> volumes_;
    Camera next_;
    double seconds_;
    std::vector<double> per_unit_;  // of each constituent, mean over the bands [1/m per unit]
};

}  // namespace uw
