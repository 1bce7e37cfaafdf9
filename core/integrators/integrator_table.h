#pragma once

#include "core/integrators/integrator_kind.h"

namespace uw {

/// The requirements, checks and factory of an integrator; k_integrator_names holds the names that
/// users write.
const IntegratorKind& integrator_kind(RenderDesc::Integrator integrator);

}  // namespace uw
