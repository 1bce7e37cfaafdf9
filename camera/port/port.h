#pragma once

#include <variant>

#include "camera/port/dome_port.h"
#include "camera/port/flat_port.h"

namespace uw {

/// The glass between camera and water. All have `refracted_ray`, `transmittance` and
/// `direction_to`.
using Port = std::variant<FlatPort, DomePort>;

inline Port make_port(const PortDesc& desc) {
    if (const auto* dome = std::get_if<DomePortDesc>(&desc)) return DomePort(*dome);
    return FlatPort(std::get<FlatPortDesc>(desc));
}

}  // namespace uw
