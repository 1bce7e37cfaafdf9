#include "core/passes/forward_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/surface_reflection.h"
#include "core/passes/water_scatter.h"

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
    require_memory(bytes,
                   fmt::format("water.forward_scatter: {} x {} pixels need another", plane.width,
                               plane.height),
                   "render a smaller --size, leave out the lamps' layers, or set K to 0");
}

}  // namespace

ForwardPass::ForwardPass(const PixelRenderer& renderer, const LitScene& scene,
                         const ForwardScatterSetup& setup, const LayerPlan& plan)
    : renderer_(renderer),
      scene_(scene),
      setup_(setup),
      lamp_paths_(scene, setup.lamp_column),
      in_scatter_(scene, *renderer.transport().integrator, lamp_paths_,
                  renderer.rays().world_from_camera(), setup.faces, setup.shells, setup.sensor),
      bands_(static_cast<std::size_t>(renderer.band_count())) {
    groups_.emplace_back();
    for (std::size_t j = 0; j < scene.lamp_count(); ++j) {
        const bool has_own = plan.first_channel_of_lamp(j) >= 0;
        if (has_own) groups_.emplace_back();
        group_of_lamp_.push_back(has_own ? groups_.size() - 1 : 0);
        groups_[group_of_lamp_.back()].lamps.push_back(j);
    }
    several_ = groups_.size() > 1;
    const bool first = plan.has(Layer::backscatter_first);
    const std::size_t constituents = scene.medium->constituents.size();
    const std::size_t per_group = (first ? 4 : 3) * bands_;
    check_memory(setup.plane, 12 + groups_.size() * per_group + (several_ ? 3 : 2) * bands_ +
                                  (setup.has_snow ? bands_ : 0) + 2 * constituents);
    for (Group& group : groups_) {
        group.direct = planes(bands_);
        group.forward = planes(bands_);
    }
    if (several_) direct_ = planes(bands_);
    backscatter_ = planes(bands_);
    if (setup.has_snow) snow_ = planes(bands_);
    added_ = planes(groups_.size() * bands_);
    if (first) first_ = planes(groups_.size() * bands_);
    response_ = planes(bands_);
    pixel_factor_.assign(setup.plane.width, setup.plane.height, 1.0F);
    from_lamps_ = to_camera_ = {setup.plane.width, setup.plane.height, constituents};
    water_ = {setup.plane.width, setup.plane.height};
}

void ForwardPass::keep(int x, int y, const RenderedPixel& pixel) {
    const std::size_t i = pixel_factor_.index(x, y);
    pixel_factor_[i] = static_cast<float>(pixel.result.pixel_factor);
    if (pixel.view.ray) water_.set(i, pixel.view, in_scatter_.depth(*pixel.view.ray));
    for (std::size_t b = 0; b < bands_; ++b)
        backscatter_[b][i] = static_cast<float>(pixel.result.backscatter[b] * factor_before(i));
    for (std::size_t b = 0; b < snow_.size(); ++b)
        snow_[b][i] = static_cast<float>(pixel.result.snow[b] * factor_before(i));
    if (!pixel.view.samples.empty()) keep_surfaces(i, pixel);
}

/// Sums over the samples of one pixel.
struct ForwardPass::SurfaceSums {
    Spectrum response{};
    std::vector<Spectrum> irradiance, direct;  // per group
    WaterPath from_lamps, to_camera;
};

void ForwardPass::keep_surfaces(std::size_t i, const RenderedPixel& pixel) {
    thread_local SurfaceSums sums;
    const std::vector<SurfaceSample>& samples = pixel.view.samples;
    sums.response = Spectrum{};
    sums.irradiance.assign(groups_.size(), Spectrum{});
    sums.direct.assign(groups_.size(), Spectrum{});
    sums.from_lamps.reset(scene_.medium->constituents.size());
    sums.to_camera.reset(scene_.medium->constituents.size());
    for (std::size_t sample = 0; sample < samples.size(); ++sample)
        add_surface(pixel, sample, sums);
    const double factor = factor_before(i);
    for (std::size_t b = 0; b < bands_; ++b) {
        response_[b][i] = as_light(sums.response[b] * factor);
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            groups_[g].forward[b][i] = as_light(sums.irradiance[g][b]);
            groups_[g].direct[b][i] = as_light(sums.direct[g][b] * factor);
        }
        std::vector<ImagePlane>& direct = several_ ? direct_ : groups_[0].direct;
        direct[b][i] = as_light(pixel.result.direct[b] * factor);
    }
    const auto set_mean = [&](const WaterPath& sum, PathImage& image) {
        thread_local WaterPath mean;
        mean.reset(sum.columns.size());
        mean.add(1.0 / static_cast<double>(samples.size()), sum.length, sum.columns);
        image.set(i, mean);
    };
    set_mean(sums.from_lamps, from_lamps_);
    set_mean(sums.to_camera, to_camera_);
}

void ForwardPass::add_surface(const RenderedPixel& pixel, std::size_t sample,
                              SurfaceSums& sums) const {
    const SurfaceSample& surface = pixel.view.samples[sample];
    const SurfaceHit& hit = surface.hit;
    const SurfaceLight& light = pixel.light;
    const std::size_t at = pixel.first_sample + sample;
    thread_local std::vector<double> column;
    column.assign(scene_.medium->constituents.size(), 0.0);
    if (!column.empty()) scene_.field->column(surface.ray.origin, hit.position, column);
    sums.to_camera.add(1, hit.distance, column);
    lamp_paths_.add_mean(1, hit.position, sums.from_lamps);
    const double weight = 1.0 / renderer_.samples();
    const double seen = setup_.sensor.surface_factor(hit.distance);
    const std::span<const double> to_camera = light.to_camera(at);
    // Light scattered on its way has no single direction: it is reflected by the diffuse part.
    for (std::size_t b = 0; b < bands_; ++b)
        sums.response[b] +=
            weight * hit.reflectance[b] * std::numbers::inv_pi * seen * to_camera[b];
    const auto add_irradiance = [&](std::size_t g, std::size_t j, Spectrum& irradiance) {
        for (std::size_t b = 0; b < bands_; ++b) {
            irradiance[b] = weight * light.irradiance(at, j, b);
            sums.irradiance[g][b] += irradiance[b];
        }
    };
    Spectrum irradiance, brdf;
    if (!several_) {  // the direct light is that of the pixel
        for (std::size_t j = 0; j < light.emitter_count(); ++j)
            if (light.visible(at, j)) add_irradiance(0, j, irradiance);
        return;
    }
    const SurfaceReflection reflection(*scene_.surfaces, surface, static_cast<int>(bands_));
    if (reflection.emits())
        for (std::size_t b = 0; b < bands_; ++b)
            sums.direct[0][b] += weight * reflection.emission()[b] * seen * to_camera[b];
    for (std::size_t j = 0; j < light.emitter_count(); ++j) {
        if (!light.visible(at, j)) continue;
        const std::size_t g = group_of_lamp_[light.emitters()[j].index()];
        add_irradiance(g, j, irradiance);
        reflection.brdf(light.emitters()[j].origin(surface.hit.position), brdf);
        for (std::size_t b = 0; b < bands_; ++b)
            sums.direct[g][b] += irradiance[b] * brdf[b] * seen * to_camera[b];
    }
}

void ForwardPass::run(const ProgressCallback& progress) {
    // Before all surfaces the error of a slab is of second order in its thickness.
    if (setup_.spacing > 1) in_scatter_.join_pairs(water_.extent().nearest, setup_.first);
    const auto steps = static_cast<double>(in_scatter_.count()) + 1;
    const auto report = [&](std::size_t done) {
        if (!progress(static_cast<double>(done) / steps)) throw Interrupted();
    };
    scatter_surfaces();
    report(1);
    scatter_water([&](std::size_t slab) { report(slab + 2); });
}

void ForwardPass::scatter_surfaces() {
    PathScatter scatter(setup_.desc, setup_.plane, *scene_.medium);
    ImagePlane added(setup_.plane.width, setup_.plane.height), light = added;
    for (Group& group : groups_) {
        for (std::size_t b = 0; b < bands_; ++b) {
            ImagePlane& forward = group.forward[b];
            scatter.add(b, forward, from_lamps_);
            scatter.finish(added);
            for (std::size_t i = 0; i < light.size(); ++i) {
                forward[i] = response_[b][i] * added[i];
                light[i] = group.direct[b][i] + forward[i];
            }
            scatter.add(b, light, to_camera_);
            scatter.finish(added);
            for (std::size_t i = 0; i < light.size(); ++i)
                forward[i] += static_cast<float>(water_.alpha(i)) * added[i];
        }
    }
}

void ForwardPass::scatter_water(const std::function<void(std::size_t slab)>& done) {
    std::vector<std::vector<std::size_t>> lamps;
    for (const Group& group : groups_) lamps.push_back(group.lamps);
    const SlabLattice lattice(renderer_, in_scatter_, water_, lamps, setup_.sensor, setup_.spacing);
    WaterScatter scatter(setup_.desc, setup_.plane, *scene_.medium, in_scatter_, water_, lattice,
                         setup_.spacing);
    const std::size_t constituents = scene_.medium->constituents.size();
    const double slab_bytes =
        4.0 * lattice.columns() * lattice.rows() *
        static_cast<double>((groups_.size() + 1) * bands_ + 2 + 2 * constituents);
    const auto together = static_cast<std::size_t>(
        std::clamp(k_slab_bytes / slab_bytes, 1.0, static_cast<double>(in_scatter_.count())));
    std::vector<SlabImages> slabs;
    for (std::size_t first = 0; first < in_scatter_.count(); first += together) {
        const std::size_t count = std::min(together, in_scatter_.count() - first);
        slabs.assign(count, lattice.images());
        lattice.integrate(first, slabs);
        for (std::size_t i = 0; i < count; ++i) {
            const double middle = in_scatter_.middle(first + i);
            const bool is_first = setup_.first.begin < middle && middle < setup_.first.end;
            scatter.add(first + i, slabs[i], is_first && !first_.empty() ? first_ : added_);
            done(first + i);
        }
    }
    scatter.finish();
    for (std::size_t n = 0; n < first_.size(); ++n)
        for (std::size_t i = 0; i < first_[n].size(); ++i) added_[n][i] += first_[n][i];
}

void ForwardPass::write(const LayerPlan& plan, const BandColour& colour, Film& film) const {
    const std::vector<ImagePlane>& direct = several_ ? direct_ : groups_[0].direct;
    for_each_row(setup_.plane, [&](int y) {
        PixelResult pixel;
        for (int x = 0; x < setup_.plane.width; ++x) {
            const std::size_t i = pixel_factor_.index(x, y);
            const auto sum = [&](const auto& of_group) {
                return per_band(bands_, [&](std::size_t b) {
                    double all = 0;
                    for (std::size_t g = 0; g < groups_.size(); ++g)
                        all += static_cast<double>(of_group(g, b));
                    return all;
                });
            };
            pixel.pixel_factor = factor_after(i);
            pixel.direct =
                per_band(bands_, [&](std::size_t b) { return static_cast<double>(direct[b][i]); });
            pixel.forward =
                sum([&](std::size_t g, std::size_t b) { return groups_[g].forward[b][i]; });
            pixel.backscatter =
                sum([&](std::size_t g, std::size_t b) { return added_[g * bands_ + b][i]; });
            for (std::size_t b = 0; b < bands_; ++b)
                pixel.backscatter[b] += static_cast<double>(backscatter_[b][i]);
            for (std::size_t b = 0; b < snow_.size(); ++b)
                pixel.snow[b] = static_cast<double>(snow_[b][i]);
            if (!first_.empty())
                pixel.backscatter_first =
                    sum([&](std::size_t g, std::size_t b) { return first_[g * bands_ + b][i]; });
            const std::span<float> channels = film.pixel(x, y);
            store_forward_scatter(pixel, plan, colour, channels);
            for (std::size_t g = 1; g < groups_.size(); ++g) {
                const auto own = [&](const ImagePlane* planes) {
                    return per_band(
                        bands_, [&](std::size_t b) { return static_cast<double>(planes[b][i]); });
                };
                pixel.forward = own(groups_[g].forward.data());
                pixel.backscatter = own(&added_[g * bands_]);
                add_forward_scatter_of_lamp(pixel, plan, groups_[g].lamps[0], channels);
            }
        }
    });
}

}  // namespace uw
