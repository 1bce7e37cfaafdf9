#pragma once

#include "core/integrators/integrator_kind.h"

namespace uw {

/// What the integrator that users know by this name (k_integrator_names) says of itself.
const IntegratorKind& integrator_kind(RenderDesc::Integrator integrator);

}  // namespace uw
