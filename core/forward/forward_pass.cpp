#include "core/forward/forward_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/surfaces/surface_reflection.h"

namespace uw {

namespace {

// Layers of water are taken together as long as they need less than this [bytes].
constexpr double k_layer_bytes = 256e6;

// What can be spread: a number, not below zero.
float as_light(double value) {
    constexpr double k_most = 1e30;
    return value > 0 ? static_cast<float>(std::min(value, k_most)) : 0.0F;
}

std::vector<ImagePlane> planes(std::size_t count, std::size_t pixels) {
    return std::vector<ImagePlane>(count, ImagePlane(pixels));
}

void for_each_row(const ScatterPlane& plane, const std::function<void(std::size_t y)>& row) {
    parallel_for(static_cast<std::size_t>(plane.height), row);
}

void check_memory(const ScatterPlane& plane, std::size_t values_per_pixel) {
    const double bytes = 4.0 * plane.width * plane.height * static_cast<double>(values_per_pixel);
    if (bytes > static_cast<double>(available_memory_bytes()))
        throw InputError(fmt::format(
            "water.forward_scatter: {} x {} pixels need {:.3g} GB of memory more; render a smaller "
            "--size or without lamps' layers, or set K to 0",
            plane.width, plane.height, bytes * 1e-9));
}

}  // namespace

/// One layer of water as images.
struct ForwardPass::Layer {
    std::vector<std::vector<ImagePlane>> light;  // [component][band]: E_s
    std::vector<ImagePlane> weight;              // per band [m]: light at the camera per E_s
    PathImage from_lamps, to_camera;
};

ForwardPass::ForwardPass(const PixelRenderer& renderer, const LitScene& scene,
                         const Integrator& integrator, const Affine& world_from_camera,
                         const ForwardScatterSetup& setup, const LayerPlan& plan)
    : renderer_(renderer),
      scene_(scene),
      integrator_(integrator),
      setup_(setup),
      lamp_paths_(scene, setup.lamp_column),
      water_(scene, integrator, lamp_paths_, world_from_camera, setup.faces, setup.shells,
             setup.cells, setup.sensor),
      bands_(static_cast<std::size_t>(renderer.band_count())),
      pixels_(static_cast<std::size_t>(setup.plane.width) *
              static_cast<std::size_t>(setup.plane.height)),
      from_lamps_(0, 0),
      to_camera_(0, 0),
      scatter_(setup.desc, setup.plane, *scene.medium) {
    std::vector<std::size_t> lamps(scene.lamps->size());
    std::iota(lamps.begin(), lamps.end(), std::size_t{0});
    std::vector<std::vector<std::size_t>> groups{lamps};
    for (const std::size_t j : lamps)
        if (plan.first_channel_of_lamp(j) >= 0) groups.push_back({j});
    const std::size_t constituents = scene.medium->constituents.size();
    check_memory(setup.plane, 7 + groups.size() * 4 * bands_ + 3 * bands_ + 4 * constituents);
    for (const auto& group : groups)
        components_.push_back(
            {group, planes(bands_, pixels_), planes(bands_, pixels_), planes(bands_, pixels_)});
    first_ = planes(bands_, pixels_);
    response_ = planes(bands_, pixels_);
    alpha_.resize(pixels_);
    pixel_factor_.resize(pixels_, 1.0);
    from_lamps_ = PathImage(pixels_, constituents);
    to_camera_ = PathImage(pixels_, constituents);
    added_.resize(pixels_);
    light_.resize(pixels_);
}

void ForwardPass::keep(int x, int y, const PixelView& view, const PixelResult& result) {
    const std::size_t i = pixel(x, y);
    alpha_[i] = static_cast<float>(result.alpha);
    pixel_factor_[i] = result.pixel_factor;
    for (std::size_t b = 0; b < bands_; ++b)
        components_[0].water[b][i] = static_cast<float>(result.backscatter[b] * factor_before(i));
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
    integrator_.surface_light(sample, light);
    column.assign(scene_.medium->constituents.size(), 0.0);
    if (!column.empty()) scene_.field->column(ray.origin, hit.position, column);
    sums.to_camera.add(1, hit.distance, column);
    lamp_paths_.add_mean(1, hit.position, sums.from_lamps);
    const double share = 1.0 / renderer_.samples();
    const double seen = setup_.sensor.surface_factor(hit.distance);
    // Light scattered on its way comes from no single direction: the diffuse part reflects it.
    for (std::size_t b = 0; b < bands_; ++b)
        sums.response[b] +=
            share * hit.reflectance[b] * std::numbers::inv_pi * seen * light.to_camera(0)[b];
    const SurfaceReflection reflection(*scene_.surfaces, sample, static_cast<int>(bands_));
    Spectrum brdf{};
    for (std::size_t c = 0; c < components_.size(); ++c) {
        for (const std::size_t j : components_[c].lamps) {
            if (!light.visible(0, j)) continue;
            reflection.brdf((*scene_.lamps)[j].position(), brdf);
            for (std::size_t b = 0; b < bands_; ++b) {
                const double irradiance = share * light.irradiance(0, j, b);
                sums.irradiance[c][b] += irradiance;
                sums.direct[c][b] += irradiance * brdf[b] * seen * light.to_camera(0)[b];
            }
        }
    }
}

void ForwardPass::run(const ProgressCallback& progress) {
    const std::size_t constituents = scene_.medium->constituents.size();
    const double layer_bytes =
        4.0 * static_cast<double>(pixels_) * static_cast<double>(2 * bands_ + 2 + 2 * constituents);
    const auto together = static_cast<std::size_t>(
        std::clamp(k_layer_bytes / layer_bytes, 1.0, static_cast<double>(water_.count())));
    const auto steps = static_cast<double>(water_.count()) + 1;
    const auto report = [&](std::size_t done) {
        if (!progress(static_cast<double>(done) / steps)) throw Interrupted();
    };
    scatter_surfaces();
    report(1);
    std::vector<Layer> layers;
    for (std::size_t first = 0; first < water_.count(); first += together) {
        const std::size_t count = std::min(together, water_.count() - first);
        while (layers.size() > count) layers.pop_back();
        while (layers.size() < count)
            layers.push_back({std::vector(components_.size(), planes(bands_, pixels_)),
                              planes(bands_, pixels_), PathImage(pixels_, constituents),
                              PathImage(pixels_, constituents)});
        gather(first, layers);
        for (std::size_t i = 0; i < count; ++i) {
            scatter_layer(first + i, layers[i]);
            report(first + i + 2);
        }
    }
}

void ForwardPass::scatter_surfaces() {
    for (Component& component : components_) {
        for (std::size_t b = 0; b < bands_; ++b) {
            ImagePlane& forward = component.forward[b];
            scatter_(b, forward, from_lamps_, added_);
            for (std::size_t i = 0; i < pixels_; ++i) {
                forward[i] = response_[b][i] * added_[i];
                light_[i] = component.direct[b][i] + forward[i];
            }
            scatter_(b, light_, to_camera_, added_);
            for (std::size_t i = 0; i < pixels_; ++i) forward[i] += alpha_[i] * added_[i];
        }
    }
}

void ForwardPass::gather(std::size_t first, std::vector<Layer>& layers) const {
    for_each_row(setup_.plane, [&](std::size_t y) {
        thread_local PixelView view;
        thread_local std::vector<SlabLight> lights;
        for (int x = 0; x < setup_.plane.width; ++x) {
            renderer_.look(x, static_cast<int>(y), view);
            if (view.ray)
                water_.gather(*view.ray, view.ends, view.shares, first, first + layers.size(),
                              lights);
            const std::size_t i = pixel(x, static_cast<int>(y));
            for (std::size_t n = 0; n < layers.size(); ++n)
                store(view.ray ? &lights[n] : nullptr, i, layers[n]);
        }
    });
}

void ForwardPass::store(const SlabLight* from, std::size_t i, Layer& layer) const {
    constexpr double k_least = std::numeric_limits<float>::min();
    const double factor = factor_before(i);
    for (std::size_t b = 0; b < bands_; ++b) {
        layer.weight[b][i] = from != nullptr ? static_cast<float>(from->weight[b] * factor) : 0.0F;
        const bool seen = from != nullptr && from->weight[b] > k_least;
        for (std::size_t c = 0; c < components_.size(); ++c) {
            double sum = 0;
            for (const std::size_t j : components_[c].lamps)
                if (seen) sum += from->lamps[j][b];
            layer.light[c][b][i] = seen ? as_light(sum / from->weight[b]) : 0.0F;
        }
    }
    if (from == nullptr) return;
    layer.from_lamps.set(i, from->to_lamps);
    layer.to_camera.set(i, from->to_camera);
}

void ForwardPass::scatter_layer(std::size_t index, Layer& layer) {
    const double middle = water_.middle(index);
    const bool is_first = setup_.first.begin < middle && middle < setup_.first.end;
    for (std::size_t c = 0; c < components_.size(); ++c) {
        for (std::size_t b = 0; b < bands_; ++b) {
            const auto add = [&](std::size_t i, float light) {
                components_[c].water[b][i] += light;
                if (is_first && c == 0) first_[b][i] += light;
            };
            const ImagePlane& light = layer.light[c][b];
            scatter_(b, light, layer.from_lamps, added_);
            for (std::size_t i = 0; i < pixels_; ++i) {
                add(i, layer.weight[b][i] * added_[i]);
                light_[i] = layer.weight[b][i] * (light[i] + added_[i]);
            }
            scatter_(b, light_, layer.to_camera, added_);
            for (std::size_t i = 0; i < pixels_; ++i) add(i, alpha_[i] * added_[i]);
        }
    }
}

void ForwardPass::write(const LayerPlan& plan, const BandColour& colour, Film& film) const {
    for_each_row(setup_.plane, [&](std::size_t y) {
        for (int x = 0; x < setup_.plane.width; ++x) {
            const std::size_t i = pixel(x, static_cast<int>(y));
            const double factor = factor_after(i);
            const auto seen = [factor](float light) {
                return static_cast<float>(static_cast<double>(light) * factor);
            };
            const std::span<float> channels = film.pixel(x, static_cast<int>(y));
            const auto set = [&](uw::Layer which, std::size_t b, float value, bool add) {
                if (!plan.has(which)) return;
                float& channel = channels[static_cast<std::size_t>(plan.first_channel(which)) + b];
                channel = add ? channel + value : value;
            };
            Spectrum total{};
            for (std::size_t b = 0; b < bands_; ++b) {
                const Component& all = components_[0];
                // Rounded before they are added: their sum is the total to the bit.
                const float direct = seen(all.direct[b][i]), forward = seen(all.forward[b][i]);
                const float water = seen(all.water[b][i]);
                const float sum = direct + forward + water;
                total[b] = static_cast<double>(sum);
                set(uw::Layer::total, b, sum, false);
                set(uw::Layer::direct, b, direct, false);
                set(uw::Layer::forward, b, forward, false);
                set(uw::Layer::backscatter, b, water, false);
                set(uw::Layer::backscatter_first, b, seen(first_[b][i]), true);
                for (std::size_t c = 1; c < components_.size(); ++c) {
                    const int first = plan.first_channel_of_lamp(components_[c].lamps[0]);
                    channels[static_cast<std::size_t>(first) + b] +=
                        seen(components_[c].forward[b][i]) + seen(components_[c].water[b][i]);
                }
            }
            const LinearRgb rgb = colour(total);
            for (std::size_t k = 0; k < 3; ++k) channels[k] = static_cast<float>(rgb[k]);
        }
    });
}

}  // namespace uw
