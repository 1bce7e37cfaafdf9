#include "core/paths/glass_passage.h"

#include <cstddef>

#include "core/geometry/glass.h"

namespace uw {

namespace {

// What is left after that many reflections inside is next to nothing.
constexpr int k_max_surfaces_of_glass = 64;

}  // namespace

std::optional<Ray> sample_glass_passage(const LitScene& scene, const Ray& ray, SurfaceHit hit,
                                        const Spectrum& throughput, PathRandom& random,
                                        Spectrum& factor) {
    const GlassOptics& glass = *scene.glass;
    const auto bands = static_cast<std::size_t>(scene.medium->band_count());
    GlassRay from{ray, glass.around(ray.origin)};
    for (int i = 0; i < k_max_surfaces_of_glass; ++i) {
        const GlassSplit split = glass.split(from, hit);
        double reflected = 0, transmitted = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            reflected += throughput[b] * factor[b] * split.reflectance[b];
            transmitted += throughput[b] * factor[b] * split.transmittance[b];
        }
        const double total = reflected + transmitted;
        if (!(total > 0)) return std::nullopt;
        const bool is_reflected = random.next() * total < reflected;
        const Spectrum& fraction = is_reflected ? split.reflectance : split.transmittance;
        const double probability = (is_reflected ? reflected : transmitted) / total;
        for (std::size_t b = 0; b < bands; ++b) factor[b] *= fraction[b] / probability;
        from = is_reflected ? split.reflected : split.transmitted;
        if (from.around.glass() == 0) return from.ray;
        if (!scene.surfaces->closest_hit(from.ray, k_far, hit) || hit.glass == 0)
            return std::nullopt;
        glass.absorb(from.around, hit.distance, factor);
    }
    return std::nullopt;
}

}  // namespace uw
