#pragma once

#include <string>
#include <vector>

#include "cli/dataset/dataset_arguments.h"
#include "core/scene/scene_desc.h"
#include "dataset/definition.h"

namespace uw {

/// The values of each draw, as `--set` takes them: those of the variations of the set, or none of
/// one draw. With `check` the scenes of all draws are read. Throws as RunScenes.
std::vector<std::vector<std::string>> draws_of(const DatasetArguments& arguments, bool check);

/// The set that the arguments ask for, but for its draws. `scene`: of its first draw. Throws
/// UsageError.
DatasetDefinition definition_of(const DatasetArguments& arguments, const SceneDesc& scene);

/// `text` as a shell reads it: in quotes if it has anything but plain characters.
std::string shell_word(const std::string& text);

/// The options that make the set, in one spelling, each after a blank: without what does not change
/// it, which is folder, shard and threads.
std::string set_options(const DatasetArguments& arguments, const DatasetDefinition& definition);

/// The scene of a draw, as the arguments ask for it. Throws as load_scene.
SceneDesc scene_of_draw(const DatasetArguments& arguments,
                        const std::vector<std::string>& overrides);

}  // namespace uw
