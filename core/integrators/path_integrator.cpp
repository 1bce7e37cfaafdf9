#include "core/integrators/path_integrator.h"

#include "core/integrators/reference_integrator.h"

namespace uw {

namespace {

// Nothing is interpolated that paths are compared with.
LightTransport make_path(const IntegratorInputs& inputs) {
    return {std::make_unique<ReferenceIntegrator>(inputs.scene),
            std::make_unique<DirectLighting>(inputs.scene)};
}

}  // namespace

constinit const IntegratorKind k_path_kind{.traces_paths = true,
                                           .multiple_scattering = true,
                                           .samples = 16,
                                           .draft_samples = 4,
                                           .make = make_path};

}  // namespace uw
