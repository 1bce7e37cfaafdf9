#pragma once

#include "cli/command.h"
#include "cli/runs/dataset_arguments.h"

namespace uw {

/// `uwvdb dataset`: throws as load_scene, Renderer and complete_dataset do; UsageError for a folder
/// that holds something else; Interrupted.
void run_dataset(const DatasetArguments& arguments);

Command dataset_command();

}  // namespace uw
