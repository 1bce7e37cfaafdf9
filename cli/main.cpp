#include <fmt/format.h>
#include <unistd.h>

#include <exception>
#include <iostream>
#include <new>
#include <variant>

#include "cli/arguments.h"
#include "cli/calibration/calibration_command.h"
#include "cli/console.h"
#include "cli/exit_code.h"
#include "cli/info/info_command.h"
#include "cli/render/render_command.h"
#include "cli/stop_signal.h"
#include "cli/validate/validate_command.h"
#include "cli/water/water_command.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace {

// One line, whatever the user's files and names brought into it.
int fail(uw::ExitCode code, const char* what) {
    constexpr std::size_t k_longest_message = 4000;
    uw::print_message(fmt::format("uwvdb: {}\n", uw::printable(what, k_longest_message)));
    return code;
}

uw::ExitCode run(const uw::MessageArguments& arguments) {
    uw::print_output(arguments.text);
    return uw::k_exit_done;
}

uw::ExitCode run(const uw::RenderArguments& arguments) {
    uw::install_stop_signal();
    uw::run_render(arguments);
    return uw::k_exit_done;
}

uw::ExitCode run(const uw::InfoArguments& arguments) {
    uw::print_output(uw::run_info(arguments));
    return uw::k_exit_done;
}

uw::ExitCode run(const uw::WaterArguments& arguments) {
    uw::run_water(arguments, std::cout);
    return uw::k_exit_done;
}

uw::ExitCode run(const uw::CalibrationArguments& arguments) {
    uw::run_calibration(arguments, std::cout);
    return uw::k_exit_done;
}

uw::ExitCode run(const uw::ValidateArguments& arguments) {
    uw::install_stop_signal();
    const bool colour = isatty(STDOUT_FILENO) != 0;
    return uw::run_validate(arguments, colour, std::cout) ? uw::k_exit_done : uw::k_exit_validation;
}

}  // namespace

int main(int argc, char** argv) {
    uw::prepare_streams();
    try {
        const uw::Arguments parsed = uw::parse_arguments(argc, argv);
        return std::visit([](const auto& arguments) { return run(arguments); }, parsed);
    } catch (const uw::UsageError& error) {
        return fail(uw::k_exit_usage, error.what());
    } catch (const uw::InputError& error) {
        return fail(uw::k_exit_input, error.what());
    } catch (const uw::IoError& error) {
        return fail(uw::k_exit_io, error.what());
    } catch (const uw::Interrupted& stop) {
        return fail(uw::k_exit_interrupted, stop.what());
    } catch (const std::bad_alloc&) {
        return fail(uw::k_exit_internal,
                    "out of memory; try --crop, fewer --layers or a smaller --size");
    } catch (const std::exception& error) {
        return fail(uw::k_exit_internal, error.what());
    }
}
