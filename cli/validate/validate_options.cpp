#include <fmt/format.h>

#include <charconv>
#include <memory>

#include "cli/command_options.h"
#include "core/base/text.h"

namespace uw {

namespace {

constexpr const char* k_validate_examples = R"(Examples:
  uwvdb validate
  uwvdb validate plume.yaml --report plume.html
  uwvdb validate uniform.yaml --set water.absorption=0.1 --tolerance 0.002

Computes a scene in every way there is and compares them, per component and band: McGlamery's
planes and their limit, adaptive quadrature, the reference integrator and a VDB of constant value
against the volume integrator in uniform water (grids replaced by their mean), and on the scene's
own grids the volume against the reference integrator. Where the scene has forward scatter, what
it makes of the light as well, and against a sum over all pairs of pixels. Without a scene: a
built-in suite.
Exit codes: 0 all within the tolerance, 5 not; 1 internal fault, 2 wrong usage, 3 bad input,
4 cannot read or write, 130 interrupted.)";

}  // namespace

Command add_validate_command(CLI::App& app) {
    CLI::App& validate =
        *app.add_subcommand("validate", "compare every way of computing a scene with the others");
    const auto p = std::make_shared<ValidateArguments>();
    validate.add_option("SCENE", p->scene, "scene file; the built-in suite if left out");
    add_set_option(validate, p->overrides);
    validate.add_option("--report", p->report, "write one HTML page with pictures and plots")
        ->type_name("FILE.html");
    validate
        .add_option("--tolerance", p->tolerance,
                    "largest relative difference allowed at a pixel; 0.001 if left out")
        ->check(CLI::Validator(
            [](const std::string& text) -> std::string {
                double value = 0;
                const char* const end = text.data() + text.size();
                const auto [next, error] = std::from_chars(text.data(), end, value);
                if (error == std::errc() && next == end && value > 0 && value <= 1) return {};
                return fmt::format("expected a number above 0, at most 1; found '{}'",
                                   printable(text));
            },
            ""))
        ->type_name("R");
    add_threads_option(validate, p->threads);
    validate.add_flag("--quiet", p->quiet, "print failed checks and errors only");
    validate.footer(k_validate_examples);
    return {&validate, [p]() -> Arguments { return *p; }};
}

}  // namespace uw
