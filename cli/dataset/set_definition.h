#pragma once

#include "cli/dataset/dataset_arguments.h"
#include "core/scene/scene_desc.h"
#include "dataset/definition.h"

namespace uw {

/// The set that the arguments ask for. `scene`: as load_scene reads it with them. Throws
/// UsageError.
DatasetDefinition definition_of(const DatasetArguments& arguments, const SceneDesc& scene);

/// The scene of a draw, as the arguments ask for it. Throws as load_scene.
SceneDesc scene_of_draw(const DatasetArguments& arguments,
                        const std::vector<std::string>& overrides);

}  // namespace uw
