#pragma once

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

/// Sets `scene.time`, and the poses of everything that moves to those of that time [s]: cameras,
/// the rig with its cameras and lamps, lamps, geometry; and the time of glTF files' animations.
/// `subject` names the moment in messages: "frame 7". Throws InputError for a time at which some
/// trajectory has no pose, with the frames that it has. Precondition: it was not set before.
void set_time(SceneDesc& scene, double time, const std::string& subject);

/// The same for a moment while a frame is exposed, which may begin before the first pose and end
/// after the last: Trajectory::at_or_beyond.
void set_time_of_exposure(SceneDesc& scene, double time);

}  // namespace uw
