#include "core/surfaces/surface_reflection.h"

#include <algorithm>
#include <numbers>

#include "core/surfaces/microfacet.h"

namespace uw {

SurfaceReflection::SurfaceReflection(const Surfaces& surfaces, const SurfaceSample& sample,
                                     int band_count)
    : sample_(&sample), bands_(static_cast<std::size_t>(band_count)) {
    if (!sample.hit.has_material) return;
    material_ = surfaces.material(sample.hit);
    emits_ = std::ranges::any_of(material_->emission, [](double radiance) { return radiance > 0; });
}

void SurfaceReflection::brdf(const Point3& position, Spectrum& values) const {
    brdf_towards(is_glossy() ? glm::normalize(position - sample_->hit.position) : Vector3(0),
                 values);
}

void SurfaceReflection::brdf_towards(const Vector3& to_light, Spectrum& values) const {
    const SurfaceHit& hit = sample_->hit;
    if (!is_glossy()) {
        for (std::size_t b = 0; b < bands_; ++b)
            values[b] = hit.reflectance[b] * std::numbers::inv_pi;
        return;
    }
    const MicrofacetLobe lobe =
        microfacet_lobe(hit.normal, -sample_->ray.direction, to_light, material_->roughness);
    for (std::size_t b = 0; b < bands_; ++b) {
        const double fresnel = lobe.fresnel(material_->f0[b]);
        values[b] =
            (1 - fresnel) * hit.reflectance[b] * std::numbers::inv_pi + fresnel * lobe.density;
    }
}

}  // namespace uw
