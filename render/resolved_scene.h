#pragma once

#include <utility>

#include "core/scene/scene_desc.h"

namespace uw {

/// `scene` seen by the chosen camera, with the files of the chosen frame instead of its sequences,
/// and everything that moves at the frame's time, or without a frame at the first moment
/// (render/scene_motion.h). Throws InputError for a frame that a trajectory does not have.
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
