#include "cli/validate/validate_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <ostream>
#include <utility>

#include "cli/console.h"
#include "cli/process.h"
#include "cli/validate/published_report.h"
#include "cli/validate/validation_report.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "render/image_scene.h"
#include "render/scene_loading.h"
#include "render/scene_rendering.h"
#include "render/validation/built_in_suite.h"
#include "render/validation/published.h"

namespace uw {

namespace {

const char* const k_validate_examples = R"(Examples:
  uwvdb validate
  uwvdb validate plume.yaml --report plume.html
  uwvdb validate --published
  uwvdb validate uniform.yaml --set water.absorption=0.1 --tolerance 0.002

Computes a scene in every available way and compares the results, per component and band:
McGlamery's planes and their limit, adaptive quadrature, the reference integrator and a VDB of
constant value against the volume integrator in uniform water (grids replaced by their mean), and on
the scene's own grids the volume against the reference integrator. If the scene has forward scatter,
its effect is compared, too, also with a sum over all pairs of pixels. If it has multiple
scattering, the fast form is compared with unbiased light paths, in units of their standard errors.
Without a scene: a built-in suite, which compares light paths with tables, too. --published: canonical
problems of ocean optics, and corners of boards in photographs through ports.
Exit codes: 0 all within the tolerance, 5 not; 1 internal fault, 2 wrong usage, 3 bad input,
4 cannot read or write, 130 interrupted.)";

Options validate_options(ValidateArguments& a) {
    Options options;
    options.input("SCENE", "", a.scene, "scene file; default: the built-in suite");
    options.set(a.overrides);
    options.output("--report", "FILE.html", a.report,
                   "write one HTML page with pictures and plots");
    options.flag("--published", a.published,
                 "compare with what others have published and photographed, some minutes");
    options.number("--tolerance", "R", a.tolerance, 0, 1,
                   "largest relative difference allowed at a pixel; default 0.001");
    options.threads(a.threads);
    options.confine();
    options.flag("--quiet", a.quiet, "print failed checks and errors only");
    return options;
}

}  // namespace

namespace {

/// Writes the page unless there is no `file` for it.
void write_report(const std::filesystem::path& file, const std::function<std::string()>& page,
                  bool quiet) {
    if (file.empty()) return;
    begin_orderly_stop();  // or a temporary file might stay
    const StopScope scope(stop_flag());
    TextFiles files;
    files.add(file, page());
    files.commit(quiet);
}

bool run_published(const ValidateArguments& a, bool colour, std::ostream& out) {
    if (!a.scene.empty()) throw UsageError("--published: has its own scenes; leave out SCENE");
    PublishedOptions options;
    if (!a.quiet) options.say = [](const std::string& what) { print_message(what + "\n"); };
    const PublishedComparison comparison = compare_with_published(options);
    out << published_text(comparison, colour) << std::flush;
    write_report(
        a.report, [&] { return published_page(comparison); }, a.quiet);
    out << (comparison.passed() ? "validation passed" : "validation FAILED") << '\n';
    if (!out.flush()) throw IoError("standard output: cannot write; is the disk full?");
    return comparison.passed();
}

}  // namespace

bool run_validate(const ValidateArguments& a, bool colour, std::ostream& out) {
    const ThreadLimit limit(a.threads);
    if (a.scene.empty() && !a.overrides.empty())
        throw UsageError("--set: the built-in suite has no scene file to change; name a scene");
    check_outputs({a.report});
    if (a.published) return run_published(a, colour, out);
    const ValidationSuite suite;
    std::vector<std::pair<std::string, SceneDesc>> scenes = suite.scenes();
    std::vector<std::pair<std::string, SceneDesc>> all_light = suite.all_light();
    if (!a.scene.empty()) {
        scenes = {{a.scene.filename().string(), load_scene(a.scene, a.overrides)}};
        check_outputs({a.report});            // which may be one of the scene's files
        scenes[0].second.water.snow.reset();  // particles do not depend on the method
        all_light.clear();
        if (layer_plan(scene_of_image(scenes[0].second, {}), {}).is_provided(Layer::multiple))
            all_light = scenes;
    }

    ValidationOptions options;
    options.tolerance = a.tolerance;
    if (!a.quiet) options.say = [](const std::string& what) { print_message(what + "\n"); };
    std::vector<SceneValidation> results;
    std::vector<LightValidation> lights;
    bool passed = true;
    const auto tell = [&](bool this_passed, const std::string& table) {
        passed = passed && this_passed;
        if (!a.quiet || !this_passed) out << table;
        out.flush();
    };
    for (auto& [name, desc] : scenes) {
        results.push_back(validate_scene(std::move(desc), name, options));
        tell(results.back().passed(), validation_table(results.back(), colour));
    }
    const auto keep = [&](LightValidation light) {
        lights.push_back(std::move(light));
        tell(lights.back().passed(), light_table(lights.back(), colour));
    };
    if (a.scene.empty()) keep(validate_by_table(options));
    for (auto& [name, desc] : all_light) keep(validate_all_light(std::move(desc), name, options));
    write_report(
        a.report, [&] { return validation_page(results, lights); }, a.quiet);
    std::ptrdiff_t uncompared = 0;
    for (const SceneValidation& scene : results)
        uncompared += std::ranges::count(scene.checks, false, &Check::is_compared);
    if (!a.quiet || !passed) {
        out << (passed ? "validation passed" : "validation FAILED");
        if (uncompared > 0) out << "; rows not compared: " << uncompared;
        out << '\n';
    }
    if (!out.flush()) throw IoError("standard output: cannot write; is the disk full?");
    return passed;
}

Command validate_command() {
    const auto arguments = std::make_shared<ValidateArguments>();
    return {"validate", "compare every way of computing a scene with the others",
            k_validate_examples, validate_options(*arguments), [arguments] {
                install_stop_signal();
                const bool colour = isatty(STDOUT_FILENO) != 0;
                return run_validate(*arguments, colour, std::cout) ? k_exit_done
                                                                   : k_exit_validation;
            }};
}

}  // namespace uw
