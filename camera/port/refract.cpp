#include "camera/port/refract.h"

#include <cmath>

#include "camera/port/fresnel.h"

namespace uw {

std::optional<Vector3> refract(const Vector3& direction, const Vector3& normal, double n1,
                               double n2) {
    const double r = n1 / n2;
    const double cos1 = glm::dot(direction, normal);
    const double cos2_squared = 1 - r * r * (1 - cos1 * cos1);
    if (!(cos2_squared > 0)) return std::nullopt;
    // sqrt(cos2^2) - r cos1, written without the difference: nothing cancels, and r = 1 gives 0.
    const double along_normal = (1 - r) * (1 + r) / (std::sqrt(cos2_squared) + r * cos1);
    return glm::normalize(r * direction + along_normal * normal);
}

template <class PortDescription>
double port_transmittance(const PortDescription& port, const PortCosines& cosines) {
    double result = 1;
    if (port.radiance_in_air) {
        const double ratio = port.n_air / port.n_water;
        result *= ratio * ratio;
    }
    if (port.fresnel) {
        const FresnelTransmittance inner =
            fresnel_transmittance(cosines.inner_air, port.n_air, port.n_glass);
        const FresnelTransmittance outer =
            fresnel_transmittance(cosines.outer_glass, port.n_glass, port.n_water);
        result *= 0.5 * (inner.s * outer.s + inner.p * outer.p);
    }
    return result;
}

template double port_transmittance(const FlatPortDesc&, const PortCosines&);
template double port_transmittance(const DomePortDesc&, const PortCosines&);

}  // namespace uw
