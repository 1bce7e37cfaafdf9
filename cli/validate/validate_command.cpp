#include "cli/validate/validate_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <memory>
#include <ostream>
#include <utility>

#include "cli/console.h"
#include "cli/stop_signal.h"
#include "cli/validate/all_light.h"
#include "cli/validate/lamp_table.h"
#include "cli/validate/light_report.h"
#include "cli/validate/validation_report.h"
#include "cli/validate/validation_suite.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/stop.h"
#include "core/files/atomic_file.h"
#include "core/integrators/integrator_table.h"
#include "render/scene_loading.h"

namespace uw {

bool run_validate(const ValidateArguments& a, bool colour, std::ostream& out,
                  const TransportWrapper& volume) {
    const ThreadLimit limit(a.threads);
    if (a.scene.empty() && !a.overrides.empty())
        throw UsageError("--set: the built-in suite has no scene file to change; name a scene");
    if (!a.report.empty()) const AtomicFile probe(a.report);
    const ValidationSuite suite;
    std::vector<std::pair<std::string, SceneDesc>> scenes = suite.scenes();
    std::vector<std::pair<std::string, SceneDesc>> all_light = suite.all_light();
    if (!a.scene.empty()) {
        scenes = {{a.scene.filename().string(), load_scene(a.scene, a.overrides)}};
        scenes[0].second.water.snow.reset();  // particles do not depend on the method
        all_light.clear();
        if (scattering_of(scenes[0].second.render) == RenderDesc::Scattering::multiple)
            all_light = scenes;
    }

    ValidationOptions options;
    options.tolerance = a.tolerance;
    options.volume = volume;
    options.proceed = [] { return !stop_requested(); };
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
    if (a.scene.empty()) keep(validate_by_table(lamp_table(), options));
    for (auto& [name, desc] : all_light) keep(validate_all_light(std::move(desc), name, options));
    if (!a.report.empty()) {
        begin_orderly_stop();  // or a temporary file might stay
        const StopScope scope(stop_flag());
        write_validation_report(a.report, results, lights);
        if (!a.quiet) print_message(fmt::format("wrote {}\n", a.report.string()));
    }
    if (!a.quiet || !passed) out << (passed ? "validation passed\n" : "validation FAILED\n");
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
