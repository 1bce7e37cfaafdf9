#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "cli/command.h"

namespace uw {

/// `uwvdb validate` as typed.
struct ValidateArguments {
    std::filesystem::path scene;         // empty: the built-in suite
    std::vector<std::string> overrides;  // --set key.path=value
    std::filesystem::path report;        // --report: HTML
    double tolerance = 1e-3;
    bool published = false;
    int threads = 0;  // 0: all
    bool quiet = false;
};

/// `uwvdb validate`: prints a table per scene to `out`, in red where a check failed and `colour` is
/// set, and writes the requested report; reports progress on stderr. Returns whether all checks
/// passed. Throws UsageError, InputError, IoError and Interrupted.
bool run_validate(const ValidateArguments& arguments, bool colour, std::ostream& out);

/// `uwvdb validate` as the command line knows it.
Command validate_command();

}  // namespace uw
