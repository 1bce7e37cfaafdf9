#include "cli/program.h"

#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "cli/console.h"
#include "cli/process.h"
#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "media/water/species_cache.h"

namespace uw {

namespace {

// One line, whatever the user's files and names contain.
int fail(ExitCode code, const char* what) {
    constexpr std::size_t k_longest_message = 4000;
    print_message(fmt::format("uwvdb: {}\n", printable(what, k_longest_message)));
    return code;
}

// Where an exception must not pass, as on the threads of libraries.
[[noreturn]] void end_by_unexpected() {
    try {
        if (const std::exception_ptr error = std::current_exception())
            std::rethrow_exception(error);
    } catch (const std::bad_alloc& error) {
        fail(k_exit_internal, line_of(error));
        std::_Exit(k_exit_internal);
    } catch (...) {
        // A fault of ours, to be looked at where it arose.
    }
    std::abort();
}

}  // namespace

int run_program(int argc, char** argv, void (*add_commands)(std::vector<Command>&)) {
    prepare_streams();
    limit_memory();
    std::set_terminate(end_by_unexpected);
    if (const std::filesystem::path cache = user_cache_folder(); !cache.empty())
        keep_species_in(cache / "uwvdb" / "species");
    try {
        std::vector<Command> commands;
        add_commands(commands);
        return read_command_line(argc, argv, commands)();
    } catch (const UsageError& error) {
        return fail(k_exit_usage, error.what());
    } catch (const InputError& error) {
        return fail(k_exit_input, error.what());
    } catch (const IoError& error) {
        return fail(k_exit_io, error.what());
    } catch (const Interrupted& stop) {
        return fail(k_exit_interrupted, stop.what());
    } catch (const std::bad_alloc& error) {
        return fail(k_exit_internal, line_of(error));
    } catch (const OutOfMemory& error) {
        return fail(k_exit_internal, error.what());
    } catch (const std::exception& error) {
        const std::string what = fmt::format(
            "{}; this is a fault of the program: please report it, with what 'uwvdb info SCENE "
            "--report' prints",
            error.what());
        return fail(k_exit_internal, what.c_str());
    }
}

}  // namespace uw
