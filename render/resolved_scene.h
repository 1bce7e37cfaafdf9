#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include "core/scene/scene_desc.h"

namespace uw {

/// Which of the images that a scene describes.
struct ImageChoice {
    std::optional<int> frame;  // of its sequences; none: files are named as they are
    std::size_t camera = 0;    // of its rig, by index

    friend bool operator==(const ImageChoice&, const ImageChoice&) = default;
};

/// `scene` seen by the chosen camera, with the chosen frame's files in place of its sequences.
SceneDesc scene_of_image(const SceneDesc& scene, const ImageChoice& choice);

/// The description of one image's scene with nothing left to look up: no sequence of which no frame
/// was chosen, and the cameras and lamps of its glTF files in it (import_gltf). This is what a
/// Renderer takes. Making one is what imports, and the only thing that does: a scene cannot be
/// imported twice, for no function takes a resolved one where it expects one as read.
class ResolvedScene {
  public:
    /// Consumes the description; whoever needs it afterwards makes the copy where it shows. Throws
    /// InputError for a sequence without a frame, and what import_gltf does.
    ResolvedScene(SceneDesc&& scene);

    const SceneDesc& desc() const { return desc_; }
    /// To change what has been resolved, such as the size of its image. What a glTF file is asked
    /// for here is not imported any more.
    SceneDesc& edit() { return desc_; }
    SceneDesc release() && { return std::move(desc_); }

  private:
    SceneDesc desc_;
};

}  // namespace uw
