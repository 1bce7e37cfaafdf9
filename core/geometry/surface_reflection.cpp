#include "core/geometry/surface_reflection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {

double dielectric_f0(double ior) {
    if (ior == 0) return 1;
    const double root = (ior - k_surface_water_index) / (ior + k_surface_water_index);
    return root * root;
}

namespace {

double alpha_squared(double roughness) {  // alpha is the roughness squared
    const double rough = std::max(roughness, k_min_roughness);
    return rough * rough * rough * rough;
}

// Found by trial: on a smooth metal, at most a faint pattern of a panel's points is visible.
constexpr double k_patch_blur = 0.7;

// D of GGX for a unit half vector on the side of the normal.
double distribution_of(const Vector3& normal, const Vector3& half, double alpha2) {
    const double nh = std::min(glm::dot(normal, half), 1.0);
    // (n.h)^2 (alpha^2 - 1) + 1, written with the sine, since the cosine loses precision.
    const Vector3 across = glm::cross(normal, half);
    const double spread = alpha2 * nh * nh + glm::dot(across, across);
    return alpha2 / (std::numbers::pi * spread * spread);
}

}  // namespace

MicrofacetLobe microfacet_lobe(const Vector3& normal, const Vector3& to_camera,
                               const Vector3& to_lamp, double roughness, double lamp_angle) {
    const Vector3 sum = to_camera + to_lamp;
    const double length = glm::length(sum);
    if (!(length > 0)) return {};  // the lamp shines from straight behind
    const Vector3 half = sum / length;
    // The half vector turns by half the angle by which the light does, and alpha is the tangent of
    // an angle between normals. Neighbouring emitters lie nearly two radii of their patches apart.
    const double blur = k_patch_blur * lamp_angle;
    const double alpha2 = std::min(alpha_squared(roughness) + blur * blur, 1.0);
    // A shading normal may point away from the viewer.
    constexpr double k_grazing = 1e-4;
    const double nl = glm::dot(normal, to_lamp);
    const double nv = std::max(glm::dot(normal, to_camera), k_grazing);
    const double nh = std::min(glm::dot(normal, half), 1.0);
    if (nl <= 0 || nh <= 0) return {};
    const double distribution = distribution_of(normal, half, alpha2);
    const double visibility = 0.5 / (nl * std::sqrt(nv * nv * (1 - alpha2) + alpha2) +
                                     nv * std::sqrt(nl * nl * (1 - alpha2) + alpha2));
    const double vh = std::clamp(glm::dot(to_camera, half), 0.0, 1.0);
    return {distribution * visibility, std::pow(1 - vh, 5)};
}

double sample_half_vector(double u, double roughness) {
    // tan(theta) = alpha sqrt(u / (1 - u)).
    const double tangent = std::sqrt(alpha_squared(roughness) * u / (1 - u));
    return tangent / (1 + std::sqrt(1 + tangent * tangent));
}

double half_vector_density(const Vector3& normal, const Vector3& to_camera, const Vector3& to_light,
                           double roughness) {
    const Vector3 sum = to_camera + to_light;
    const double length = glm::length(sum);
    if (!(length > 0)) return 0;
    const Vector3 half = sum / length;
    const double nh = glm::dot(normal, half), vh = glm::dot(to_camera, half);
    if (nh <= 0 || vh <= 0) return 0;
    return distribution_of(normal, half, alpha_squared(roughness)) * nh / (4 * vh);
}

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

void SurfaceReflection::brdf_towards(const Vector3& to_light, Spectrum& values,
                                     double lamp_angle) const {
    const SurfaceHit& hit = sample_->hit;
    if (!is_glossy()) {
        for (std::size_t b = 0; b < bands_; ++b)
            values[b] = hit.reflectance[b] * std::numbers::inv_pi;
        return;
    }
    const MicrofacetLobe lobe = microfacet_lobe(hit.normal, -sample_->ray.direction, to_light,
                                                material_->roughness, lamp_angle);
    for (std::size_t b = 0; b < bands_; ++b) {
        const double fresnel = lobe.fresnel(material_->f0[b]);
        values[b] =
            (1 - fresnel) * hit.reflectance[b] * std::numbers::inv_pi + fresnel * lobe.density;
    }
}

}  // namespace uw
