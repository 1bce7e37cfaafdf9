#pragma once

#include <optional>
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

/// The ray in water of one in the housing, camera frame; without a port, that ray itself.
inline std::optional<Ray> through_port(const std::optional<Port>& port, const Ray& in_housing) {
    if (!port) return in_housing;
    return std::visit(
        [&](const auto& glass) {
            return glass.refracted_ray(in_housing.origin, in_housing.direction);
        },
        *port);
}

}  // namespace uw
