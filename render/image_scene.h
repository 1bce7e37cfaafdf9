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

/// Whether anything in the scene has a trajectory, is animated or drifts, so that frames differ by
/// their times.
bool has_motion(const SceneDesc& scene);

/// The frames for which everything that moves has a pose: those within all trajectories; without
/// any, those of all animations of glTF files. Frames are counted from 0. None if nothing moves or
/// no frame is in all of them.
std::optional<FrameRange> frames_of(const SceneDesc& scene);

/// Whether everything that has a trajectory has a pose in a frame, and meshes that are one file for
/// each frame have one for it.
bool has_frame(const SceneDesc& scene, int frame);

/// The time of a frame (RenderDesc::times) [s]. Throws InputError for one that a scene with the
/// times of a trajectory does not have.
double time_of_frame(const SceneDesc& scene, int frame);

/// The moment that is shown without a frame's number: the first, from 0 on, at which everything
/// that moves has a pose [s].
double first_time(const SceneDesc& scene);

/// A volume with the files of a frame, if it is a sequence.
VolumeDesc volume_of_frame(VolumeDesc volume, int frame);

/// Where the camera of an image is. It is that of ImageScene, but files are read only where the
/// camera is one of a glTF file's. Throws as ImageScene.
Affine world_from_camera(const SceneDesc& whole, const ImageChoice& choice);

/// The scene of one image: of one frame, one camera and one moment, with nothing left to look up.
/// Sequences have the files of the frame, everything that moves is where it is at the moment, and
/// the cameras and lamps of glTF files are included (import_gltf). It never changes: what differs
/// from it is another. This is what a Renderer takes.
class ImageScene {
  public:
    /// The image `choice` of a scene as it was read. Its moment is the frame's time, or without a
    /// frame the first moment. Throws InputError for a sequence without a frame, and for a frame
    /// that a trajectory does not have; and throws as import_gltf and check_limits.
    ImageScene(std::shared_ptr<const SceneDesc> whole, const ImageChoice& choice);
    /// Consumes the description. A caller that needs it afterwards makes a copy that one sees.
    ImageScene(SceneDesc&& whole, const ImageChoice& choice = {});

    /// What the image shows.
    const SceneDesc& desc() const { return desc_; }
    /// The scene as it was read, for what other images of it show.
    const SceneDesc& whole() const { return *whole_; }
    const ImageChoice& choice() const { return choice_; }
    /// The moment [s]; none: nothing in the scene moves.
    std::optional<double> time() const { return time_; }

    /// The scene with another description, such as that of a smaller image or of fewer lamps. What
    /// `change` requests of a glTF file is not imported.
    ImageScene with(const std::function<void(SceneDesc&)>& change) const;
    /// At another moment of the frame's exposure [s], which may begin before the first pose and end
    /// after the last: the poses of everything that moves, and of what its glTF files show, are
    /// those of then; nothing else changes. Precondition: it has a time.
    ImageScene at(double time) const;
    /// Seen by another camera of the rig, at the same moment.
    ImageScene seen_by(std::size_t camera) const;
    /// The scene of the frame `step` later, seen by the same camera; none if it has no such frame.
    std::optional<ImageScene> neighbour(int step) const;

  private:
    std::shared_ptr<const SceneDesc> whole_;
    ImageChoice choice_;
    std::optional<double> time_;
    SceneDesc desc_;
};

/// The scene of an image, for a caller that goes on to use `whole`.
ImageScene scene_of_image(const SceneDesc& whole, const ImageChoice& choice);

/// Throws InputError if the choice is of a frame that a trajectory does not have.
void check_moment(const SceneDesc& whole, const ImageChoice& choice);

}  // namespace uw
