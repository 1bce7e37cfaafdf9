#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace uw {

/// A command of the program as CLI11 parses it; `finish` turns what was parsed into arguments and
/// throws UsageError for what cannot be.
struct Command {
    CLI::App* app = nullptr;
    std::function<Arguments()> finish;
};

Command add_render_command(CLI::App& app);
Command add_info_command(CLI::App& app);
Command add_water_command(CLI::App& app);
Command add_validate_command(CLI::App& app);
Command add_calibration_command(CLI::App& app);

/// `--set KEY.PATH=VALUE`, any number of times.
void add_set_option(CLI::App& command, std::vector<std::string>& overrides);
/// `--threads N`.
void add_threads_option(CLI::App& command, int& threads);
/// A check like CLI::Range that reads "expected 1 to 4096, found 'abc'".
CLI::Validator in_range(int low, int high);

}  // namespace uw
