#pragma once

#include <optional>
#include <utility>

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

/// Sets `scene.time`, and the poses of everything that moves to those of that time [s]: cameras,
/// the rig with its cameras and lamps, lamps, geometry; and the time of glTF files' animations.
/// `subject` names the moment in messages: "frame 7". Throws InputError for a time at which some
/// trajectory has no pose, with the frames that it has. Precondition: it was not set before.
void set_time(SceneDesc& scene, double time, const std::string& subject);

/// The same for a moment while a frame is exposed, which may begin before the first pose and end
/// after the last: Trajectory::at_or_beyond.
void set_time_of_exposure(SceneDesc& scene, double time);

/// `scene` seen by the chosen camera, with the files of the chosen frame instead of its sequences,
/// and everything that moves at the frame's time, or without a frame at the first moment
/// (render/resolved_scene.h). Throws InputError for a frame that a trajectory does not have.
SceneDesc scene_of_image(const SceneDesc& scene, const ImageChoice& choice);

/// The description of one image's scene with nothing left to look up: no sequence without a chosen
/// frame, what moves at some moment (the first, if none was chosen), and the cameras and lamps of
/// its glTF files included (import_gltf). This is what a Renderer takes. Constructing one is what
/// imports: a scene cannot be imported twice, as no function takes a resolved one where it expects
/// one as read.
class ResolvedScene {
  public:
    /// Consumes the description; a caller that needs it afterwards makes an explicit copy. Throws
    /// InputError for a sequence without a frame, and as import_gltf and check_limits.
    ResolvedScene(SceneDesc&& scene);

    const SceneDesc& desc() const { return desc_; }
    /// For changing what has been resolved, such as the size of its image. What is requested of a
    /// glTF file here is no longer imported.
    SceneDesc& edit() { return desc_; }
    SceneDesc release() && { return std::move(desc_); }

  private:
    SceneDesc desc_;
};

/// A resolved scene at another moment of its frame's exposure [s]: the poses of everything that
/// moves, and of what its glTF files show, are those of then; nothing else changes. Precondition:
/// it has SceneDesc::whole and a time.
SceneDesc scene_at(const SceneDesc& scene, double time);

}  // namespace uw
