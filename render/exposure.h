#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "camera/camera.h"
#include "core/passes/pass.h"
#include "render/scene_assembly.h"
#include "render/scene_rendering.h"

namespace uw {

/// The exposure of a frame while something moves, around the frame's time: the shutter's time, and
/// with a rolling shutter that of all rows. It is divided into parts of equal length. The image of
/// a part has light and surfaces of the part's middle, while the camera moves on from sample to
/// sample; the frame's is the mean over them (ExposureMean).
///
/// There are as many parts as keep what each takes as still from moving by more than a few pixels
/// of the image: surfaces by half of one, the light of lamps by two, the water before a camera that
/// moves by four; but no more than 64, nor than there are samples.
class Exposure {
  public:
    /// The exposure of an assembled scene; without motion it has no parts. `scene` outlives this.
    explicit Exposure(const AssembledScene& scene);

    /// 0: the image is that of the frame's time, as nothing moves.
    int part_count() const { return parts_; }
    /// How far something moves in the image while it is exposed, at most [pixels].
    double motion_pixels() const;
    /// Samples per pixel of a row in all parts that it is exposed in, and in one.
    int samples() const;
    int samples_of_part() const { return samples_of_part_; }
    bool is_rolling() const { return rows_.line_time > 0; }
    /// Whether surfaces move.
    bool moves_surfaces() const { return moves_surfaces_; }

    /// The scene of part `part`, from 0 on, assembled.
    AssembledScene part(int part, SceneCache& cache) const;
    /// The share that a part has of the exposure of pixel row `row`.
    double share(int part, int row) const { return rows_of(part).share(row); }
    /// Whether the middle of the row's exposure, which its ground truth is of, is in the part.
    bool has_middle(int part, int row) const;

  private:
    double bound(int part) const;
    RowExposure rows_of(int part) const;
    void measure(const std::vector<ImageScene>& moments);
    void divide(int samples);

    const AssembledScene& scene_;
    RowExposure rows_;
    std::shared_ptr<const CameraMotion> camera_;  // null: it stands still
    bool moves_surfaces_ = false;
    int parts_ = 0, samples_of_part_ = 1;
    // The furthest that things move in the image over all the time [pixels]: what stands still, as
    // the camera moves; surfaces and the light of lamps, to a camera that does not.
    double view_pixels_ = 0, surface_pixels_ = 0, light_pixels_ = 0;
};

/// How the camera of an image moves around its time [s] over `span`; null if it stands still, or if
/// nothing of the scene moves.
std::shared_ptr<const CameraMotion> camera_motion(const ImageScene& scene, const TimeSpan& span);

/// The camera of an image as ground truth has it: each row in the middle of its exposure.
Camera camera_of_truth(const ImageScene& scene);

/// Makes the light of the lamps of a part of an exposure, if its integrator needs any.
using LightOfPart = std::function<DeepShadows(const AssembledScene& part)>;

/// Renders the image of `scene`, of which something moves while it is exposed, into a
/// film whose values are 0: the light as the mean over the exposure's parts, the ground truth that
/// of the middle, or with a rolling shutter of the middle of each row's exposure. Runs all of
/// `passes` but those of the whole image; all of it is the stage "render".
void render_exposure(const Exposure& exposure, const AssembledScene& scene, SceneCache& cache,
                     PassList& passes, const LightOfPart& light_of_part, Rendering& rendering);

}  // namespace uw
