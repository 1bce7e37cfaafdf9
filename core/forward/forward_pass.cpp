#include "core/forward/forward_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/surfaces/surface_reflection.h"

namespace uw {

namespace {

// Memory limit for the slabs processed at once [bytes].
constexpr double k_slab_bytes = 256e6;

// Light in a form that can be blurred: finite and non-negative.
float as_light(double value) {
    constexpr double k_most = 1e30;
    return value > 0 ? static_cast<float>(std::min(value, k_most)) : 0.0F;
}

void for_each_row(const ScatterPlane& plane, const std::function<void(int y)>& row) {
    parallel_for(static_cast<std::size_t>(plane.height),
                 [&](std::size_t y) { row(static_cast<int>(y)); });
}

void check_memory(const ScatterPlane& plane, std::size_t values_per_pixel) {
    const double bytes = 4.0 * plane.width * plane.height * static_cast<double>(values_per_pixel);
    if (bytes > static_cast<double>(available_memory_bytes()))
        throw InputError(
            fmt::format("water.forward_scatter: {} x {} pixels need another {:.3g} GB of memory; "
                        "render a smaller --size, leave out the lamps' layers, or set K to 0",
                        plane.width, plane.height, bytes * 1e-9));
}

}  // namespace

/// One slab of water as images.
struct ForwardPass::Slab {
    std::vector<std::vector<ImagePlane>> light;  // [component][band]: E_s
    std::vector<ImagePlane> weight;              // per band [m]: light at the camera per E_s
    PathImage from_lamps, to_camera;
};

ForwardPass::ForwardPass(const PixelRenderer& renderer, const LitScene& scene,
                         const ForwardScatterSetup& setup, const LayerPlan& plan)
    : renderer_(renderer),
      scene_(scene),
      setup_(setup),
      lamp_paths_(scene, setup.lamp_column),
      in_scatter_(scene, *renderer.transport().integrator, lamp_paths_,
                  renderer.rays().world_from_camera(), setup.faces, setup.shells, setup.sensor),
      bands_(static_cast<std::size_t>(renderer.band_count())),
      scatter_(setup.desc, setup.plane, *scene.medium) {
    std::vector<std::size_t> lamps(scene.lamps->size());
    std::iota(lamps.begin(), lamps.end(), std::size_t{0});
    std::vector<std::vector<std::size_t>> groups{lamps};
    for (const std::size_t j : lamps)
        if (plan.first_channel_of_lamp(j) >= 0) groups.push_back({j});
    const std::size_t constituents = scene.medium->constituents.size();
    check_memory(setup.plane, 7 + groups.size() * 4 * bands_ + 3 * bands_ + 4 * constituents);
    for (const auto& group : groups)
        components_.push_back({group, planes(bands_), planes(bands_), planes(bands_)});
    first_ = planes(bands_);
    response_ = planes(bands_);
    alpha_.assign(setup.plane.width, setup.plane.height);
    pixel_factor_.assign(setup.plane.width, setup.plane.height, 1.0);
    from_lamps_ = paths();
    to_camera_ = paths();
    added_.assign(setup.plane.width, setup.plane.height);
    light_.assign(setup.plane.width, setup.plane.height);
}

PathImage ForwardPass::paths() const {
    return {setup_.plane.width, setup_.plane.height, scene_.medium->constituents.size()};
}

void ForwardPass::keep(int x, int y, const PixelView& view, const PixelResult& result) {
    const std::size_t i = alpha_.index(x, y);
    alpha_[i] = static_cast<float>(result.alpha);
    pixel_factor_[i] = result.pixel_factor;
    for (std::size_t b = 0; b < bands_; ++b)
        components_[0].backscatter[b][i] =
            static_cast<float>(result.backscatter[b] * factor_before(i));
    if (!view.samples.empty()) keep_surfaces(i, view, result);
}

/// Sums over the samples of one pixel.
struct ForwardPass::SurfaceSums {
    Spectrum response{};
    std::vector<Spectrum> irradiance, direct;  // per component
    WaterPath from_lamps, to_camera;
};

void ForwardPass::keep_surfaces(std::size_t i, const PixelView& view, const PixelResult& result) {
    SurfaceSums sums;
    sums.irradiance.resize(components_.size());
    sums.direct.resize(components_.size());
    sums.from_lamps.reset(scene_.medium->constituents.size());
    sums.to_camera.reset(scene_.medium->constituents.size());
    for (const SurfaceSample& sample : view.samples) add_surface(sample, sums);
    const double factor = factor_before(i);
    for (std::size_t b = 0; b < bands_; ++b) {
        response_[b][i] = as_light(sums.response[b] * factor);
        for (std::size_t c = 0; c < components_.size(); ++c) {
            components_[c].forward[b][i] = as_light(sums.irradiance[c][b]);
            components_[c].direct[b][i] = as_light(sums.direct[c][b] * factor);
        }
        components_[0].direct[b][i] = as_light(result.direct[b] * factor);
    }
    const auto set_mean = [&](const WaterPath& sum, PathImage& image) {
        WaterPath mean;
        mean.reset(sum.columns.size());
        mean.add(1.0 / static_cast<double>(view.samples.size()), sum.length, sum.columns);
        image.set(i, mean);
    };
    set_mean(sums.from_lamps, from_lamps_);
    set_mean(sums.to_camera, to_camera_);
}

void ForwardPass::add_surface(const SurfaceSample& sample, SurfaceSums& sums) const {
    const auto& [ray, hit, x, y] = sample;
    thread_local SurfaceLight light;
    thread_local std::vector<double> column;
    renderer_.transport().surfaces->evaluate_one(sample, light);
    column.assign(scene_.medium->constituents.size(), 0.0);
    if (!column.empty()) scene_.field->column(ray.origin, hit.position, column);
    sums.to_camera.add(1, hit.distance, column);
    lamp_paths_.add_mean(1, hit.position, sums.from_lamps);
    const double weight = 1.0 / renderer_.samples();
    const double seen = setup_.sensor.surface_factor(hit.distance);
    const std::span<const double> to_camera = std::as_const(light).to_camera(0);
    // Light scattered on its way has no single direction: it is reflected by the diffuse part.
    sums.response += per_band(bands_, [&](std::size_t b) {
        return weight * hit.reflectance[b] * std::numbers::inv_pi * seen * to_camera[b];
    });
    const SurfaceReflection reflection(*scene_.surfaces, sample, static_cast<int>(bands_));
    Spectrum brdf;
    for (std::size_t c = 0; c < components_.size(); ++c) {
        for (const std::size_t j : components_[c].lamps) {
            if (!light.visible(0, j)) continue;
            reflection.brdf((*scene_.lamps)[j].position(), brdf);
            const Spectrum irradiance =
                per_band(bands_, [&](std::size_t b) { return weight * light.irradiance(0, j, b); });
            sums.irradiance[c] += irradiance;
            sums.direct[c] += per_band(bands_, [&](std::size_t b) {
                return irradiance[b] * brdf[b] * seen * to_camera[b];
            });
        }
    }
}

void ForwardPass::run(const ProgressCallback& progress) {
    const std::size_t constituents = scene_.medium->constituents.size();
    const double slab_bytes = 4.0 * static_cast<double>(alpha_.size()) *
                              static_cast<double>(2 * bands_ + 2 + 2 * constituents);
    const auto together = static_cast<std::size_t>(
        std::clamp(k_slab_bytes / slab_bytes, 1.0, static_cast<double>(in_scatter_.count())));
    const auto steps = static_cast<double>(in_scatter_.count()) + 1;
    const auto report = [&](std::size_t done) {
        if (!progress(static_cast<double>(done) / steps)) throw Interrupted();
    };
    scatter_surfaces();
    report(1);
    std::vector<Slab> slabs;
    for (std::size_t first = 0; first < in_scatter_.count(); first += together) {
        const std::size_t count = std::min(together, in_scatter_.count() - first);
        while (slabs.size() > count) slabs.pop_back();
        while (slabs.size() < count)
            slabs.push_back({std::vector(components_.size(), planes(bands_)), planes(bands_),
                             paths(), paths()});
        integrate(first, slabs);
        for (std::size_t i = 0; i < count; ++i) {
            scatter_slab(first + i, slabs[i]);
            report(first + i + 2);
        }
    }
}

void ForwardPass::scatter_surfaces() {
    for (Component& component : components_) {
        for (std::size_t b = 0; b < bands_; ++b) {
            ImagePlane& forward = component.forward[b];
            scatter_(b, forward, from_lamps_, added_);
            for (std::size_t i = 0; i < light_.size(); ++i) {
                forward[i] = response_[b][i] * added_[i];
                light_[i] = component.direct[b][i] + forward[i];
            }
            scatter_(b, light_, to_camera_, added_);
            for (std::size_t i = 0; i < light_.size(); ++i) forward[i] += alpha_[i] * added_[i];
        }
    }
}

void ForwardPass::integrate(std::size_t first, std::vector<Slab>& slabs) const {
    for_each_row(setup_.plane, [&](int y) {
        thread_local PixelView view;
        thread_local std::vector<SlabLight> lights;
        for (int x = 0; x < setup_.plane.width; ++x) {
            renderer_.trace(x, y, view);
            if (view.ray)
                in_scatter_.integrate(*view.ray, view.distances, view.weights, first,
                                      first + slabs.size(), lights);
            for (std::size_t n = 0; n < slabs.size(); ++n)
                store(view.ray ? &lights[n] : nullptr, alpha_.index(x, y), slabs[n]);
        }
    });
}

void ForwardPass::store(const SlabLight* light, std::size_t i, Slab& slab) const {
    constexpr double k_least = std::numeric_limits<float>::min();
    const double factor = factor_before(i);
    for (std::size_t b = 0; b < bands_; ++b) {
        slab.weight[b][i] = light != nullptr ? static_cast<float>(light->weight[b] * factor) : 0.0F;
        const bool seen = light != nullptr && light->weight[b] > k_least;
        for (std::size_t c = 0; c < components_.size(); ++c) {
            double sum = 0;
            for (const std::size_t j : components_[c].lamps)
                if (seen) sum += light->lamps[j][b];
            slab.light[c][b][i] = seen ? as_light(sum / light->weight[b]) : 0.0F;
        }
    }
    if (light == nullptr) return;
    slab.from_lamps.set(i, light->to_lamps);
    slab.to_camera.set(i, light->to_camera);
}

void ForwardPass::scatter_slab(std::size_t index, Slab& slab) {
    const double middle = in_scatter_.middle(index);
    const bool is_first = setup_.first.begin < middle && middle < setup_.first.end;
    for (std::size_t c = 0; c < components_.size(); ++c) {
        for (std::size_t b = 0; b < bands_; ++b) {
            const auto add = [&](std::size_t i, float light) {
                components_[c].backscatter[b][i] += light;
                if (is_first && c == 0) first_[b][i] += light;
            };
            const ImagePlane& light = slab.light[c][b];
            scatter_(b, light, slab.from_lamps, added_);
            for (std::size_t i = 0; i < light_.size(); ++i) {
                add(i, slab.weight[b][i] * added_[i]);
                light_[i] = slab.weight[b][i] * (light[i] + added_[i]);
            }
            scatter_(b, light_, slab.to_camera, added_);
            for (std::size_t i = 0; i < light_.size(); ++i) add(i, alpha_[i] * added_[i]);
        }
    }
}

void ForwardPass::write(const LayerPlan& plan, const BandColour& colour, Film& film) const {
    const Component& all = components_[0];
    const auto at = [&](const std::vector<ImagePlane>& image, std::size_t i) {
        return per_band(bands_, [&](std::size_t b) { return static_cast<double>(image[b][i]); });
    };
    for_each_row(setup_.plane, [&](int y) {
        PixelResult pixel;
        for (int x = 0; x < setup_.plane.width; ++x) {
            const std::size_t i = alpha_.index(x, y);
            pixel.pixel_factor = factor_after(i);
            pixel.direct = at(all.direct, i);
            pixel.forward = at(all.forward, i);
            pixel.backscatter = at(all.backscatter, i);
            pixel.backscatter_first = at(first_, i);
            const std::span<float> channels = film.pixel(x, y);
            store_forward_scatter(pixel, plan, colour, channels);
            for (std::size_t c = 1; c < components_.size(); ++c) {
                pixel.forward = at(components_[c].forward, i);
                pixel.backscatter = at(components_[c].backscatter, i);
                add_forward_scatter_of_lamp(pixel, plan, components_[c].lamps[0], channels);
            }
        }
    });
}

}  // namespace uw
