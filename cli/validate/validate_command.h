#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/validate/validation.h"
#include "core/base/output_files.h"
#include "core/scene/scene_desc.h"

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

/// The built-in scenes of `uwvdb validate`: lamps beside, far from, behind and in view of the
/// camera, both kinds of phase function, a port, a shadow, a spot, and a plume in a grid that is
/// written to a folder of its own for as long as the suite exists. The last three scatter forward,
/// with both kernels.
class ValidationSuite {
  public:
    ValidationSuite();

    /// Name and description of each.
    const std::vector<std::pair<std::string, SceneDesc>>& scenes() const { return scenes_; }

    /// Those of which all light is compared.
    const std::vector<std::pair<std::string, SceneDesc>>& all_light() const { return all_light_; }

  private:
    ScratchFolder folder_;
    std::vector<std::pair<std::string, SceneDesc>> scenes_, all_light_;
};

/// `uwvdb validate`: prints a table per scene to `out`, in red where a check failed and `colour` is
/// set, and writes the requested report; reports progress on stderr. Returns whether all checks
/// passed. `volume` wraps the volume integrator if given: tests use it to show that the checks can
/// fail. Throws UsageError, InputError, IoError and Interrupted.
bool run_validate(const ValidateArguments& arguments, bool colour, std::ostream& out,
                  const TransportWrapper& volume = {});

/// `uwvdb validate` as the command line knows it.
Command validate_command();

}  // namespace uw
