#pragma once

#include "cli/dataset/dataset_arguments.h"
#include "cli/options.h"

namespace uw {

/// The options of `uwvdb dataset`.
Options dataset_options(DatasetArguments& arguments);

/// What its --help ends with: examples, the formats, exit codes.
std::string dataset_examples();

}  // namespace uw
