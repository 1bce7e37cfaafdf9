#include "core/frame/glow_source.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/surfaces/surface_reflection.h"

namespace uw {

GlowSource::GlowSource(const PixelRenderer& pixels, const MultipleNodes& estimator)
    : pixels_(pixels),
      estimator_(estimator),
      bands_(static_cast<std::size_t>(pixels.band_count())) {
    find_gains();
}

void GlowSource::find_radiance(const SurfaceSample& sample, const SurfaceLight& light,
                               std::size_t index, std::span<double> radiance) const {
    std::ranges::fill(radiance, 0.0);
    add_direct(sample, light, index, radiance);
    for (std::size_t k = 0; k < radiance.size(); ++k) radiance[k] *= gains_[k];
}

// Of what it emits, and of the light of lamps that it reflects.
void GlowSource::add_direct(const SurfaceSample& sample, const SurfaceLight& light,
                            std::size_t index, std::span<double> radiance) const {
    const std::size_t groups = estimator_.options().groups;
    const LitScene& scene = pixels_.scene();
    const std::span<const double> to_camera = light.to_camera(index);
    const SurfaceReflection reflection(*scene.surfaces, sample, static_cast<int>(bands_));
    if (reflection.emits())
        for (std::size_t b = 0; b < bands_; ++b)
            radiance[(groups - 1) * bands_ + b] += reflection.emission()[b] * to_camera[b];
    Spectrum brdf;
    for (std::size_t j = 0; j < light.lamp_count(); ++j) {
        if (!light.visible(index, j)) continue;
        reflection.brdf((*scene.lamps)[j].position(), brdf);
        double* sum = &radiance[std::min(j, groups - 1) * bands_];
        for (std::size_t b = 0; b < bands_; ++b)
            sum[b] += light.irradiance(index, j, b) * brdf[b] * to_camera[b];
    }
}

// From a few surfaces all over the image, whatever part of it is rendered.
void GlowSource::find_gains() {
    constexpr int k_across = 16, k_paths = 64;
    constexpr double k_most_gain = 100;
    const RaySource& rays = pixels_.rays();
    const std::size_t values = estimator_.options().groups * bands_;
    std::vector<std::vector<double>> direct(k_across * k_across), indirect(k_across * k_across);
    parallel_for(direct.size(), [&](std::size_t at) {
        const int i = static_cast<int>(at) % k_across, j = static_cast<int>(at) / k_across;
        const double x = (i + 0.5) * rays.width() / k_across;
        const double y = (j + 0.5) * rays.height() / k_across;
        const std::optional<Ray> ray = rays.refracted_ray(x, y);
        if (!ray) return;
        SurfaceSample sample{*ray, {}, x, y};
        if (!pixels_.scene().surfaces->closest_hit(*ray, k_far, sample.hit)) return;
        SurfaceLight light;
        pixels_.transport().surfaces->evaluate_one(sample, light);
        direct[at].assign(values, 0.0);
        add_direct(sample, light, 0, direct[at]);
        NodeLight diffuse;
        estimator_.estimate_surface(sample, k_paths, diffuse);
        indirect[at].assign(values, 0.0);
        for (std::size_t k = 0; k < values; ++k)
            indirect[at][k] = static_cast<double>(diffuse.diffuse[k]) *
                              sample.hit.reflectance[k % bands_] *
                              std::as_const(light).to_camera(0)[k % bands_];
    });
    gains_.assign(values, 1.0);
    for (std::size_t k = 0; k < values; ++k) {
        double of_lamps = 0, others = 0;
        for (std::size_t at = 0; at < direct.size(); ++at) {
            if (direct[at].empty()) continue;
            of_lamps += direct[at][k];
            others += indirect[at][k];
        }
        if (of_lamps > 0) gains_[k] = std::min(k_most_gain, 1 + others / of_lamps);
    }
}

}  // namespace uw
