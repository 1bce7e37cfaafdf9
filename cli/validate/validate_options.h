#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/options.h"

namespace uw {

/// `uwvdb validate` as typed.
struct ValidateArguments {
    std::filesystem::path scene;         // empty: the built-in suite
    std::vector<std::string> overrides;  // --set key.path=value
    std::filesystem::path report;        // --report: HTML
    double tolerance = 1e-3;
    int threads = 0;  // 0: all
    bool quiet = false;
};

/// What `uwvdb validate --help` ends with.
extern const char* const k_validate_examples;

/// The options of `uwvdb validate`, written to `arguments`.
Options validate_options(ValidateArguments& arguments);

}  // namespace uw
