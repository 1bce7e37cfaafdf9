#include "core/light/patch_profile.h"

namespace uw {

double relative_intensity_towards(const Lamp& emitter, const SurfaceSample& sample) {
    const Point3& x = sample.hit.position;
    // Other profiles change little across a part.
    if (!emitter.is_part() || emitter.sunlight() != nullptr || !emitter.has_even_core())
        return emitter.relative_intensity(x - emitter.origin(x));
    constexpr std::size_t k_places = 8;
    double sum = 0;
    for (std::size_t number = 0; number < k_places; ++number)
        sum += emitter.relative_intensity(x - shadow_origin(emitter, sample, number));
    return sum / k_places;
}

}  // namespace uw
