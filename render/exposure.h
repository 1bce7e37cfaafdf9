#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "camera/camera.h"
#include "core/passes/pass.h"
#include "render/scene_assembly.h"
#include "render/scene_rendering.h"

namespace uw {

/// The exposure of a frame in which something moves, around the frame's time: the time that the
/// shutter is open and, with a rolling shutter, that of all rows. It is divided into parts of equal
/// length. The image of a part has the light and the surfaces of the part's middle, while the
/// camera moves from sample to sample; the frame's image is the mean over the parts (ExposureMean).
///
/// Light that was scattered more than once varies slowly: it is traced at a few moments of the
/// exposure, whose parts share it (Pass::share). From one moment to the next nothing moves by more
/// than a fraction of the image's height.
///
/// There are so many parts that what is taken as still in a part moves by no more than a few pixels
/// in the image: surfaces by half a pixel, the light of lamps by two, the water in front of a
/// moving camera by four. There are at most 64 parts, and no more than samples.
class Exposure {
  public:
    /// The exposure of an assembled scene; without motion, it has no parts. `scene` must outlive
    /// this object.
    explicit Exposure(const AssembledScene& scene);

    /// The number of parts; 0 if nothing moves and the image is that of the frame's time.
    int part_count() const { return parts_; }
    /// The maximum distance by which anything moves in the image while it is exposed [pixels].
    double motion_pixels() const;
    /// The samples per pixel in all parts in which its row is exposed, and in a single part.
    int samples() const;
    int samples_of_part() const { return samples_of_part_; }
    bool is_rolling() const { return rows_.line_time > 0; }
    /// Whether surfaces move.
    bool moves_surfaces() const { return moves_surfaces_; }

    /// Assembles the scene of part `part`, counted from 0.
    AssembledScene part(int part, SceneCache& cache) const;
    /// If `part` is the first of those around a moment, assembles the scene of that moment. None if
    /// each part has a moment of its own.
    std::optional<AssembledScene> moment_from(int part, SceneCache& cache) const;
    /// The fraction of the exposure of pixel row `row` that belongs to a part.
    double fraction(int part, int row) const { return rows_of(part).fraction(row); }
    /// Whether the part contains the middle of the row's exposure, the time of its ground truth.
    bool has_middle(int part, int row) const;

  private:
    double bound(int part) const;
    RowExposure rows_of(int part) const { return rows_of(part, part + 1); }
    RowExposure rows_of(int first, int end) const;
    AssembledScene scene_of(const RowExposure& rows, SceneCache& cache) const;
    void measure(const std::vector<ImageScene>& moments);
    void divide(int samples);

    const AssembledScene& scene_;
    RowExposure rows_;
    std::shared_ptr<const CameraMotion> camera_;  // null if it does not move
    bool moves_surfaces_ = false;
    int parts_ = 0, samples_of_part_ = 1;
    int moments_ = 1;  // at most as many as parts
    // The maximum distances in the image over the whole exposure [pixels]: of points at rest by the
    // camera's motion, and of surfaces and of the light of lamps, with the camera at rest.
    double view_pixels_ = 0, surface_pixels_ = 0, light_pixels_ = 0;
};

/// Returns the motion of an image's camera around the image's time over `span` [s]; null if the
/// camera, or the whole scene, does not move.
std::shared_ptr<const CameraMotion> camera_motion(const ImageScene& scene, const TimeSpan& span);

/// Returns the camera of an image for ground truth: each row is that of the middle of its exposure.
Camera camera_of_truth(const ImageScene& scene);

/// Returns the fraction of an image's pixels that is done when its passes report this progress of a
/// stage: forward scatter follows the pixels, all other stages precede them.
double fraction_of_pixels(Stage stage, double fraction);

/// Makes the deep shadow maps of a part of an exposure, if its integrator needs any.
using LightOfPart = std::function<DeepShadows(const AssembledScene& part)>;

/// Renders the image of `scene`, in which something moves during the exposure, into a film whose
/// values are 0. The light is the mean over the exposure's parts; ground truth is that of the
/// middle or, with a rolling shutter, of the middle of each row's exposure. Runs all of `passes`
/// but those of the whole image, as the stage "render".
void render_exposure(const Exposure& exposure, const AssembledScene& scene, SceneCache& cache,
                     PassList& passes, const LightOfPart& light_of_part, Rendering& rendering);

}  // namespace uw
