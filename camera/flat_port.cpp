#include "camera/flat_port.h"

#include <cmath>

#include "camera/fresnel.h"

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

std::optional<Ray> FlatPort::water_ray(const Vector3& direction) const {
    const Vector3& n = desc_.normal;
    const double cos_air = glm::dot(direction, n);
    if (!(cos_air > 0)) return std::nullopt;
    const auto in_glass = refract(direction, n, desc_.n_air, desc_.n_glass);
    if (!in_glass) return std::nullopt;
    const auto in_water = refract(*in_glass, n, desc_.n_glass, desc_.n_water);
    if (!in_water) return std::nullopt;

    const Vector3 inner = (desc_.distance / cos_air) * direction;
    const Vector3 outer = inner + (desc_.thickness / glm::dot(*in_glass, n)) * *in_glass;
    const double reach = glm::dot(outer, outer);
    if (!std::isfinite(reach)) return std::nullopt;
    return Ray{at_origin_plus(outer), *in_water};
}

double FlatPort::transmittance(const Vector3& direction) const {
    double result = 1;
    if (desc_.radiance_in_air) {
        const double ratio = desc_.n_air / desc_.n_water;
        result *= ratio * ratio;
    }
    if (desc_.fresnel) {
        const Vector3& n = desc_.normal;
        const auto in_glass = refract(direction, n, desc_.n_air, desc_.n_glass);
        if (!in_glass) return 0;
        const FresnelTransmittance inner =
            fresnel_transmittance(glm::dot(direction, n), desc_.n_air, desc_.n_glass);
        const FresnelTransmittance outer =
            fresnel_transmittance(glm::dot(*in_glass, n), desc_.n_glass, desc_.n_water);
        // The surfaces are parallel and share their plane of incidence: what the first polarises
        // meets the second so.
        result *= 0.5 * (inner.s * outer.s + inner.p * outer.p);
    }
    return result;
}

}  // namespace uw
