#include "cli/validate/validate_options.h"

namespace uw {

const char* const k_validate_examples = R"(Examples:
  uwvdb validate
  uwvdb validate plume.yaml --report plume.html
  uwvdb validate uniform.yaml --set water.absorption=0.1 --tolerance 0.002

Computes a scene in every available way and compares the results, per component and band:
McGlamery's planes and their limit, adaptive quadrature, the reference integrator and a VDB of
constant value against the volume integrator in uniform water (grids replaced by their mean), and on
the scene's own grids the volume against the reference integrator. If the scene has forward scatter,
its effect is compared, too, also with a sum over all pairs of pixels. If it has multiple
scattering, the fast form is compared with unbiased light paths, in units of their standard errors.
Without a scene: a built-in suite, which compares light paths with tables, too.
Exit codes: 0 all within the tolerance, 5 not; 1 internal fault, 2 wrong usage, 3 bad input,
4 cannot read or write, 130 interrupted.)";

Options validate_options(ValidateArguments& a) {
    Options options;
    options.path("SCENE", "", a.scene, "scene file; default: the built-in suite");
    options.set(a.overrides);
    options.path("--report", "FILE.html", a.report, "write one HTML page with pictures and plots");
    options.number("--tolerance", "R", a.tolerance, 0, 1,
                   "largest relative difference allowed at a pixel; default 0.001");
    options.threads(a.threads);
    options.confine();
    options.flag("--quiet", a.quiet, "print failed checks and errors only");
    return options;
}

}  // namespace uw
