#pragma once

#include <optional>

#include "core/image/image_metadata.h"
#include "render/renderer.h"

namespace uw {

/// The part of an image's header that follows from the scene's description alone: images of the
/// same scene, frame, request and program have the same.
ImageMetadata metadata_of(const SceneDesc& scene, std::optional<int> frame,
                          const PathRequest& paths = {});

/// The whole header of an image; `report` is about it.
ImageMetadata metadata_of(const AssembledScene& scene, std::optional<int> frame,
                          const PathRequest& paths = {}, const RenderReport& report = {});

}  // namespace uw
