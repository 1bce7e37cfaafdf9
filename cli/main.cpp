#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <vector>

#include "cli/calibration_command.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/edit_command.h"
#include "cli/fit/fit_command.h"
#include "cli/info/info_command.h"
#include "cli/measure_command.h"
#include "cli/points_commands.h"
#include "cli/process.h"
#include "cli/render/dataset_command.h"
#include "cli/render/render_command.h"
#include "cli/render/sweep_command.h"
#include "cli/shell.h"
#include "cli/validate/validate_command.h"
#include "cli/water_command.h"
#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "media/water/species_cache.h"

namespace {

// One line, whatever the user's files and names contain.
int fail(uw::ExitCode code, const char* what) {
    constexpr std::size_t k_longest_message = 4000;
    uw::print_message(fmt::format("uwvdb: {}\n", uw::printable(what, k_longest_message)));
    return code;
}

// Adds the program's commands in the order in which --help lists them.
void add_all(std::vector<uw::Command>& commands) {
    commands.push_back(uw::render_command());
    commands.push_back(uw::dataset_command());
    commands.push_back(uw::info_command());
    commands.push_back(uw::water_command());
    commands.push_back(uw::measure_command());
    commands.push_back(uw::fit_command());
    commands.push_back(uw::sweep_command());
    commands.push_back(uw::validate_command());
    commands.push_back(uw::edit_command());
    commands.push_back(uw::calibration_command());
    commands.push_back(uw::project_command());
    commands.push_back(uw::rays_command());
    commands.push_back(uw::completion_command(commands));
    commands.push_back(uw::manual_command(commands));
}

// Where an exception must not pass, as on the threads of libraries.
[[noreturn]] void end_by_unexpected() {
    try {
        if (const std::exception_ptr error = std::current_exception())
            std::rethrow_exception(error);
    } catch (const std::bad_alloc& error) {
        fail(uw::k_exit_internal, uw::line_of(error));
        std::_Exit(uw::k_exit_internal);
    } catch (...) {
        // A fault of ours, to be looked at where it arose.
    }
    std::abort();
}

}  // namespace

int main(int argc, char** argv) {
    uw::prepare_streams();
    uw::limit_memory();
    std::set_terminate(end_by_unexpected);
    if (const std::filesystem::path cache = uw::user_cache_folder(); !cache.empty())
        uw::keep_species_in(cache / "uwvdb" / "species");
    try {
        std::vector<uw::Command> commands;
        add_all(commands);
        return uw::read_command_line(argc, argv, commands)();
    } catch (const uw::UsageError& error) {
        return fail(uw::k_exit_usage, error.what());
    } catch (const uw::InputError& error) {
        return fail(uw::k_exit_input, error.what());
    } catch (const uw::IoError& error) {
        return fail(uw::k_exit_io, error.what());
    } catch (const uw::Interrupted& stop) {
        return fail(uw::k_exit_interrupted, stop.what());
    } catch (const std::bad_alloc& error) {
        return fail(uw::k_exit_internal, uw::line_of(error));
    } catch (const uw::OutOfMemory& error) {
        return fail(uw::k_exit_internal, error.what());
    } catch (const std::exception& error) {
        const std::string what = fmt::format(
            "{}; this is a fault of the program: please report it, with what 'uwvdb info SCENE "
            "--report' prints",
            error.what());
        return fail(uw::k_exit_internal, what.c_str());
    }
}
