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
    find_indirect();
}

void GlowSource::find_radiance(const SurfaceSample& sample, const SurfaceLight& light,
                               std::size_t index, std::span<double> radiance) const {
    std::ranges::fill(radiance, 0.0);
    add_direct(sample, light, index, radiance);
    const std::span<const double> to_camera = light.to_camera(index);
    for (std::size_t k = 0; k < radiance.size(); ++k) {
        const double white = sample.hit.reflectance[k % bands_] * to_camera[k % bands_];
        radiance[k] += indirect_[k].per_direct * radiance[k] + indirect_[k].ambient * white;
    }
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
    for (std::size_t j = 0; j < light.emitter_count(); ++j) {
        if (!light.visible(index, j)) continue;
        const Lamp& emitter = light.emitters()[j];
        reflection.brdf(emitter.origin(sample.hit.position), brdf);
        double* sum = &radiance[std::min(emitter.index(), groups - 1) * bands_];
        for (std::size_t b = 0; b < bands_; ++b)
            sum[b] += light.irradiance(index, j, b) * brdf[b] * to_camera[b];
    }
}

// By least squares over a few surfaces all over the image, whatever part of it is rendered.
void GlowSource::find_indirect() {
    constexpr int k_across = 16, k_paths = 64;
    const RaySource& rays = pixels_.rays();
    const std::size_t values = estimator_.options().groups * bands_;
    // What the camera sees of a surface, by group and band.
    struct Seen {
        std::vector<double> direct, indirect, white;  // white: per ambient light
    };
    std::vector<Seen> seen(k_across * k_across);
    parallel_for(seen.size(), [&](std::size_t at) {
        const int i = static_cast<int>(at) % k_across, j = static_cast<int>(at) / k_across;
        const double x = (i + 0.5) * rays.width() / k_across;
        const double y = (j + 0.5) * rays.height() / k_across;
        const std::optional<Ray> ray = rays.refracted_ray(x, y);
        if (!ray) return;
        SurfaceSample sample{*ray, {}, x, y};
        if (!pixels_.scene().surfaces->closest_hit(*ray, k_far, sample.hit)) return;
        SurfaceLight light;
        pixels_.transport().surfaces->evaluate_one(sample, light);
        Seen& of = seen[at];
        of.direct.assign(values, 0.0);
        add_direct(sample, light, 0, of.direct);
        NodeLight diffuse;
        estimator_.estimate_surface(sample, k_paths, diffuse);
        for (std::size_t k = 0; k < values; ++k) {
            of.white.push_back(sample.hit.reflectance[k % bands_] *
                               std::as_const(light).to_camera(0)[k % bands_]);
            of.indirect.push_back(static_cast<double>(diffuse.diffuse[k]) * of.white.back());
        }
    });
    indirect_.assign(values, {});
    for (std::size_t k = 0; k < values; ++k) {
        double dd = 0, dw = 0, ww = 0, di = 0, wi = 0;
        for (const Seen& of : seen) {
            if (of.direct.empty()) continue;
            dd += of.direct[k] * of.direct[k];
            dw += of.direct[k] * of.white[k];
            ww += of.white[k] * of.white[k];
            di += of.direct[k] * of.indirect[k];
            wi += of.white[k] * of.indirect[k];
        }
        // Neither may be negative; if one is, the other stands alone.
        constexpr double k_independent = 1e-6;
        const double determinant = dd * ww - dw * dw;
        Indirect& of = indirect_[k];
        if (determinant > k_independent * dd * ww) {
            of.per_direct = (di * ww - wi * dw) / determinant;
            of.ambient = (wi * dd - di * dw) / determinant;
        }
        if (!(of.ambient > 0)) of = {dd > 0 ? di / dd : 0, 0};
        if (!(of.per_direct > 0)) of = {0, ww > 0 ? wi / ww : 0};
    }
}

}  // namespace uw
