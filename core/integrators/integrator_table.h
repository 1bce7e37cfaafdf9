#pragma once

#include "core/integrators/integrator_kind.h"

namespace uw {

/// The needs, refusals and factory of an integrator, which users know by its name in
/// k_integrator_names.
const IntegratorKind& integrator_kind(RenderDesc::Integrator integrator);

}  // namespace uw
