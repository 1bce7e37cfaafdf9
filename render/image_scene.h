#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/scene/scene_desc.h"

namespace uw {

/// The frames of a scene, both ends included.
struct FrameRange {
    int first = 0, last = 0;
};

/// Whether anything in the scene has a trajectory, is animated or drifts, so that images depend on
/// time.
bool has_motion(const SceneDesc& scene);

/// Returns the frames for which everything that moves has a pose: those within all trajectories or,
/// without any, those of all animations of glTF files. Frames are counted from 0. None if nothing
/// moves or no frame is in all of them.
std::optional<FrameRange> frames_of(const SceneDesc& scene);

/// Whether everything that has a trajectory has a pose in a frame, and meshes that have one file
/// for each frame have one for this frame.
bool has_frame(const SceneDesc& scene, int frame);

/// Returns the time of a frame (RenderDesc::times) [s]. Throws InputError for a frame that a scene
/// with the times of a trajectory does not have.
double time_of_frame(const SceneDesc& scene, int frame);

/// Returns the time of an image without a frame's number: the first one >= 0 at which everything
/// that moves has a pose [s].
double first_time(const SceneDesc& scene);

/// Returns a volume with the files of a frame, if it is a sequence.
VolumeDesc volume_of_frame(VolumeDesc volume, int frame);

/// Returns the pose of an image's camera. It is that of ImageScene, but files are read only if the
/// camera is from a glTF file. Throws as ImageScene.
Affine world_from_camera(const SceneDesc& whole, const ImageChoice& choice);

/// The complete scene of one image: of one frame, one camera and one time. Sequences have the files
/// of the frame, everything that moves has its pose at the time, and the cameras and lamps of glTF
/// files are included (import_gltf). It is immutable. This is what a Renderer takes.
class ImageScene {
  public:
    /// The image `choice` of a scene as it was read. Its time is the frame's or, without a frame,
    /// first_time. Throws InputError for a sequence without a frame, and for a frame that a
    /// trajectory does not have; and throws as import_gltf and check_limits.
    ImageScene(std::shared_ptr<const SceneDesc> whole, const ImageChoice& choice);
    /// Consumes the description. A caller that needs it afterwards has to copy it explicitly.
    ImageScene(SceneDesc&& whole, const ImageChoice& choice = {});

    /// The scene that the image shows.
    const SceneDesc& desc() const { return desc_; }
    /// The scene as it was read, from which other images can be made.
    const SceneDesc& whole() const { return *whole_; }
    const ImageChoice& choice() const { return choice_; }
    /// The time [s]; none if nothing in the scene moves.
    std::optional<double> time() const { return time_; }

    /// Returns the scene with another description, such as that of a smaller image or of fewer
    /// lamps. If `change` refers to parts of a glTF file, these are not imported.
    ImageScene with(const std::function<void(SceneDesc&)>& change) const;
    /// Returns the scene at another time of the frame's exposure [s], which may begin before the
    /// first pose and end after the last. The poses of everything that moves, including objects of
    /// glTF files, are those at that time; nothing else changes. Precondition: it has a time.
    ImageScene at(double time) const;
    /// Returns the scene for another camera of the rig, at the same time.
    ImageScene seen_by(std::size_t camera) const;
    /// Returns the scene of the frame `step` later, for the same camera; none if there is no such
    /// frame.
    std::optional<ImageScene> neighbour(int step) const;

  private:
    std::shared_ptr<const SceneDesc> whole_;
    ImageChoice choice_;
    std::optional<double> time_;
    SceneDesc desc_;
};

/// Returns the scene of an image, for a caller that still needs `whole`.
ImageScene scene_of_image(const SceneDesc& whole, const ImageChoice& choice);

/// Throws InputError if `choice` has a frame that a trajectory does not have.
void check_moment(const SceneDesc& whole, const ImageChoice& choice);

}  // namespace uw
