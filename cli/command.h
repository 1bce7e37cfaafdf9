#pragma once

#include <functional>
#include <string>

#include "cli/exit_code.h"
#include "cli/options.h"

namespace uw {

/// A command of the program: `uwvdb NAME`.
struct Command {
    std::string name;
    std::string summary;  // one line, in lower case: "render a scene to a multi-layer EXR"
    std::string
        examples;  // what --help ends with: "Examples:\n  uwvdb ...", explanations, exit codes
    Options options;
    /// Does the work, after the options have been read. Owns the variables that hold them.
    std::function<ExitCode()> run;
};

}  // namespace uw
