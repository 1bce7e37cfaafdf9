#include "camera/port/fresnel.h"

#include <cmath>

namespace uw {

FresnelTransmittance fresnel_transmittance(double cos1, double n1, double n2) {
    const double r = n1 / n2;
    const double cos2_squared = 1 - r * r * (1 - cos1 * cos1);
    if (!(cos1 > 0) || !(cos2_squared > 0)) return {0, 0};
    const double cos2 = std::sqrt(cos2_squared);
    // T = (n2 cos2) / (n1 cos1) |t|^2, in the form that shows its symmetry.
    const double passed = 4 * n1 * cos1 * n2 * cos2;
    const double across = n1 * cos1 + n2 * cos2;
    const double in_plane = n2 * cos1 + n1 * cos2;
    return {passed / (across * across), passed / (in_plane * in_plane)};
}

}  // namespace uw
