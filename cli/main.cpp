#include <vector>

#include "cli/command.h"
#include "cli/fit/fit_command.h"
#include "cli/info/info_command.h"
#include "cli/pages/shell.h"
#include "cli/program.h"
#include "cli/render/render_command.h"
#include "cli/runs/dataset_command.h"
#include "cli/runs/sweep_command.h"
#include "cli/tools/calibration_command.h"
#include "cli/tools/coefficients_command.h"
#include "cli/tools/edit_command.h"
#include "cli/tools/import_command.h"
#include "cli/tools/measure_command.h"
#include "cli/tools/points_commands.h"
#include "cli/tools/record_command.h"
#include "cli/tools/water_command.h"
#include "cli/validate/validate_command.h"

namespace {

// Adds the program's commands in the order in which --help lists them.
void add_all(std::vector<uw::Command>& commands) {
    commands.push_back(uw::render_command());
    commands.push_back(uw::dataset_command());
    commands.push_back(uw::info_command());
    commands.push_back(uw::water_command());
    commands.push_back(uw::coefficients_command());
    commands.push_back(uw::record_command());
    commands.push_back(uw::measure_command());
    commands.push_back(uw::fit_command());
    commands.push_back(uw::sweep_command());
    commands.push_back(uw::validate_command());
    commands.push_back(uw::edit_command());
    commands.push_back(uw::import_command());
    commands.push_back(uw::calibration_command());
    commands.push_back(uw::project_command());
    commands.push_back(uw::rays_command());
    commands.push_back(uw::completion_command(commands));
    commands.push_back(uw::manual_command(commands));
}

}  // namespace

int main(int argc, char** argv) {
    return uw::run_program(argc, argv, add_all);
}
