#pragma once

#include "cli/options.h"
#include "cli/render/render_arguments.h"

namespace uw {

/// What `uwvdb render --help` ends with.
extern const char* const k_render_examples;

/// The options of `uwvdb render`, written to `arguments`.
Options render_options(RenderArguments& arguments);

}  // namespace uw
