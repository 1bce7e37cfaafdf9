#pragma once

#include <vector>

#include "cli/dataset/dataset_arguments.h"
#include "dataset/definition.h"

namespace uw {

/// The views of `range` that are to be rendered, by their indices: those that are not there whole,
/// and those that an input file has changed since. Inputs that are part of the scene's hash are
/// part of the definition. Throws as load_scene.
std::vector<std::size_t> missing_views(const DatasetArguments& arguments,
                                       const DatasetDefinition& definition, ViewRange range);

}  // namespace uw
