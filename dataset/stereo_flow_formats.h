#pragma once

#include "core/scene/scene_desc.h"
#include "dataset/definition.h"
#include "dataset/view.h"

namespace uw {

/// Whether the rig's first two cameras are a rectified pair, the first on the left: equal and
/// without distortion or port, their axes parallel and across the line between them.
bool is_rectified(const SceneDesc& scene);

/// Throws UsageError of one line for a scene whose disparity is not one number per pixel.
void check_rectified(const DatasetDefinition& definition, const SceneDesc& scene);

/// Throws InputError if the disparity of an image is not along its rows.
void check_disparity(const ViewImages& images);

}  // namespace uw
