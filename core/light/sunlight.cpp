#include "core/light/sunlight.h"

#include "core/geometry/water_surface.h"

namespace uw {

Sunlight Sunlight::from_air(const Vector3& direction, const WaterSurfaceDesc& surface) {
    if (!surface.n) return {direction, surface};
    const WaterSurfaceDesc calm = without_waves(surface);
    return {WaterSurface(calm).into_water(direction), calm};
}

}  // namespace uw
