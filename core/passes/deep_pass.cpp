#include "core/passes/deep_pass.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/light/ray_transmittance.h"

namespace uw {

namespace {

// What lies behind this transmittance has one sample: flattening in 32-bit floats would lose it.
constexpr double k_min_transmittance = 1e-5;
// The ends of the stretches that are merged to the pixel's samples: some where the transmittance
// has fallen by equal steps, some by equal factors of the distance, since light of lamps near the
// camera comes from the first decimetres however clear the water is.
constexpr int k_opacity_steps = 40, k_distance_steps = 24;
constexpr double k_nearest_end = 0.02;  // m

/// What a pixel shows of a stretch of water or of a surface.
struct DeepLayer {
    double begin = 0, end = 0;  // along the ray [m]; equal for a surface
    double transmittance = 1;   // of the pixel at its end, relative to that before everything
    Spectrum light;             // that arrives at the camera
};

/// Distributes `total` over the lights in proportion to their values in each band, or to `share`
/// where they have none.
void scale_to(const Spectrum& total, std::size_t bands, std::span<const double> share,
              std::span<Spectrum> lights) {
    double shares = 0;
    for (const double of_light : share) shares += of_light;
    for (std::size_t b = 0; b < bands; ++b) {
        double sum = 0;
        for (const Spectrum& light : lights) sum += light[b];
        for (std::size_t i = 0; i < lights.size(); ++i) {
            if (sum > 0)
                lights[i][b] *= total[b] / sum;
            else
                lights[i][b] = shares > 0 ? total[b] * share[i] / shares
                                          : total[b] / static_cast<double>(lights.size());
        }
    }
}

/// Makes the deep samples of one pixel.
class DeepPixel {
  public:
    DeepPixel(const Rendering& rendering, const AttenuationTable& attenuation,
              const RenderedPixel& pixel)
        : rendering_(rendering),
          pixel_(pixel),
          view_(pixel.view),
          bands_(static_cast<std::size_t>(rendering.pixels.band_count())),
          through_(attenuation, *rendering.pixels.scene().field, *pixel.view.ray,
                   pixel.view.distances.back()) {}

    void make(std::vector<DeepSample>& samples);

  private:
    void choose_ends();
    void add_water(std::vector<Spectrum>& lights) const;
    void add_surfaces(std::vector<Spectrum>& of_surfaces) const;
    void make_layers();
    void add_lamps();
    void merge(std::size_t most);
    void store(std::vector<DeepSample>& samples) const;

    double visible(double end, std::size_t groups_passed) const;
    double weight_beyond(std::size_t stretch) const;
    std::size_t group_of(double distance) const;
    float depth(double s) const;

    const Rendering& rendering_;
    const RenderedPixel& pixel_;
    const PixelView& view_;
    std::size_t bands_;
    RayTransmittance through_;
    std::vector<double> ends_;          // of stretches of water [m]
    std::size_t reached_surfaces_ = 0;  // of view_.distances, which have layers of their own
    std::vector<DeepLayer> layers_;
};

// The last stretch ends where nothing is seen any more, or at the farthest surface.
void DeepPixel::choose_ends() {
    const double far = through_.end();
    const std::optional<double> dark = through_.distance_at(k_min_transmittance);
    const double reach = dark ? std::min(far, *dark) : far;
    const double opacity = 1 - through_.mean_transmittance(reach);
    for (int i = 1; i < k_opacity_steps; ++i)
        if (const auto s = through_.distance_at(1 - opacity * i / k_opacity_steps))
            ends_.push_back(*s);
    for (int i = 0; i < k_distance_steps; ++i)
        ends_.push_back(k_nearest_end *
                        std::pow(reach / k_nearest_end, static_cast<double>(i) / k_distance_steps));
    for (const double distance : view_.distances) {
        if (distance >= k_far || (dark && distance >= reach)) continue;
        ends_.push_back(distance);
        ++reached_surfaces_;
    }
    ends_.push_back(reach);
    std::sort(ends_.begin(), ends_.end());
    std::erase_if(ends_, [&](double s) { return !(s > 0) || s > reach; });
    ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
}

/// The fraction of the pixel that sees at least as far as the end of a stretch.
double DeepPixel::weight_beyond(std::size_t stretch) const {
    const bool is_last = stretch + 1 == ends_.size();
    double weight = 0;
    for (std::size_t k = 0; k < view_.distances.size(); ++k)
        if (view_.distances[k] >= ends_[stretch] || (is_last && k >= reached_surfaces_))
            weight += view_.weights[k];
    return weight;
}

// The in-scattered light that was integrated for this ray may differ from that of the image, which
// is interpolated between rays: the image's is kept, distributed as along the ray.
void DeepPixel::add_water(std::vector<Spectrum>& lights) const {
    std::vector<double> distances = ends_;
    distances.back() = std::max(distances.back(), view_.distances.back());
    InScatter single;
    rendering_.pixels.transport().integrator->in_scatter(*view_.ray, distances, single);
    std::vector<Spectrum> multiple(ends_.size());
    std::vector<double> share(ends_.size());
    Spectrum before, multiple_before;
    for (std::size_t i = 0; i < ends_.size(); ++i) {
        const double weight = weight_beyond(i);
        Spectrum up_to, multiple_up_to;
        for (std::size_t j = 0; j < single.lamp_count(); ++j) up_to += single.at(i, j);
        if (rendering_.multiple_up_to)
            multiple_up_to = rendering_.multiple_up_to(view_, distances[i]);
        for (std::size_t b = 0; b < bands_; ++b) {
            lights[i][b] = weight * std::max(0.0, up_to[b] - before[b]);
            multiple[i][b] = weight * std::max(0.0, multiple_up_to[b] - multiple_before[b]);
        }
        before = up_to;
        multiple_before = multiple_up_to;
        share[i] = weight * (through_.mean_transmittance(i == 0 ? 0 : ends_[i - 1]) -
                             through_.mean_transmittance(ends_[i]));
    }
    scale_to(pixel_.result.backscatter, bands_, share, lights);
    scale_to(pixel_.result.multiple_volume, bands_, share, multiple);
    for (std::size_t i = 0; i < lights.size(); ++i) lights[i] += multiple[i];
}

std::size_t DeepPixel::group_of(double distance) const {
    std::size_t nearest = 0;
    const auto difference = [&](std::size_t k) {
        return std::abs(std::log(view_.distances[k] / distance));
    };
    for (std::size_t k = 1; k < view_.distances.size(); ++k)
        if (difference(k) < difference(nearest)) nearest = k;
    return nearest;
}

// Surfaces reflect each its own light of lamps; what they reflect of all other light is distributed
// by what the pixel sees of them.
void DeepPixel::add_surfaces(std::vector<Spectrum>& of_surfaces) const {
    const PixelRenderer& pixels = rendering_.pixels;
    std::vector<double> share(of_surfaces.size(), 0.0);
    Spectrum lamps;
    PixelResult one;
    for (std::size_t i = 0; i < view_.samples.size(); ++i) {
        const SurfaceSample& sample = view_.samples[i];
        one.reset(0, bands_);
        pixels.add_surface(sample, pixel_.light, pixel_.first_sample + i, one);
        const std::size_t group = group_of(sample.hit.distance);
        of_surfaces[group] += one.direct;
        share[group] += through_.mean_transmittance(std::min(sample.hit.distance, through_.end()));
    }
    scale_to(pixel_.result.direct - pixel_.result.lamps_in_view, bands_, share, of_surfaces);
    std::vector<Spectrum> indirect(of_surfaces.size());
    for (std::size_t k = 0; k < indirect.size(); ++k) {
        const Spectrum depth = through_.optical_depth(std::min(view_.distances[k], through_.end()));
        if (share[k] > 0)
            for (std::size_t b = 0; b < bands_; ++b)
                indirect[k][b] = view_.weights[k] * std::exp(-depth[b]);
    }
    scale_to(pixel_.result.multiple_surface, bands_, share, indirect);
    for (std::size_t k = 0; k < indirect.size(); ++k) of_surfaces[k] += indirect[k];
}

/// The transmittance of the pixel up to `end`, behind the nearest `groups_passed` surfaces: samples
/// without a ray see through everything.
double DeepPixel::visible(double end, std::size_t groups_passed) const {
    double open = 0;
    for (std::size_t k = groups_passed; k < view_.distances.size(); ++k) open += view_.weights[k];
    return std::max(0.0, 1 - view_.alpha) + open * through_.mean_transmittance(end);
}

void DeepPixel::make_layers() {
    std::vector<Spectrum> of_water(ends_.size()), of_surfaces(view_.distances.size());
    add_water(of_water);
    add_surfaces(of_surfaces);
    std::size_t surface = 0;
    double begin = 0;
    for (std::size_t i = 0; i < ends_.size(); ++i) {
        layers_.push_back({begin, ends_[i], visible(ends_[i], surface), of_water[i]});
        begin = ends_[i];
        for (; surface < reached_surfaces_ && view_.distances[surface] == begin; ++surface)
            layers_.push_back({begin, begin, visible(begin, surface + 1), of_surfaces[surface]});
    }
    if (surface == view_.distances.size()) return;
    for (; surface < view_.distances.size(); ++surface)
        layers_.back().light += of_surfaces[surface];
    layers_.back().transmittance = std::max(0.0, 1 - view_.alpha);
}

void DeepPixel::add_lamps() {
    PixelResult one;
    for (const SeenLamp& lamp : view_.lamps) {
        one.reset(0, bands_);
        rendering_.pixels.add_lamp(lamp, one);
        const auto holds = [&](const DeepLayer& layer) { return layer.end >= lamp.distance; };
        const auto found = std::ranges::find_if(layers_, holds);
        (found == layers_.end() ? layers_.back() : *found).light += one.direct;
    }
}

// Each sample has about the same part of the water's opacity and light together.
void DeepPixel::merge(std::size_t most) {
    double light = 0, opacity = 0, before = 1;
    const auto is_surface = [](const DeepLayer& layer) { return layer.begin == layer.end; };
    const auto sum_of = [&](const DeepLayer& layer) {
        double sum = 0;
        for (const double band : layer.light.first(bands_)) sum += band;
        return sum;
    };
    std::size_t surfaces = 0;
    for (const DeepLayer& layer : layers_) {
        if (is_surface(layer)) {
            ++surfaces;
        } else {
            light += sum_of(layer);
            opacity += before - layer.transmittance;
        }
        before = layer.transmittance;
    }
    // A surface parts the water before and behind it, which may cost a sample more.
    const double parts = static_cast<double>(most > 2 * surfaces + 1 ? most - 2 * surfaces : 1);
    std::vector<DeepLayer> merged;
    double measure = 0, last_part = -1;
    before = 1;
    for (const DeepLayer& layer : layers_) {
        double part = -1;
        if (!is_surface(layer)) {
            double own = 0;
            if (light > 0) own += 0.5 * sum_of(layer) / light;
            if (opacity > 0) own += 0.5 * (before - layer.transmittance) / opacity;
            part = std::min(parts - 1, std::floor((measure + 0.5 * own) * parts));
            measure += own;
        }
        before = layer.transmittance;
        if (part >= 0 && part == last_part) {
            merged.back().end = layer.end;
            merged.back().transmittance = layer.transmittance;
            merged.back().light += layer.light;
        } else {
            merged.push_back(layer);
        }
        last_part = part;
    }
    layers_ = std::move(merged);
}

float DeepPixel::depth(double s) const {
    const RaySource& rays = rendering_.pixels.rays();
    return static_cast<float>((rays.world_from_camera().inverse() * view_.ray->at(s)).z);
}

// Alphas are rounded before light is divided by what they leave, so that flattening is exact.
void DeepPixel::store(std::vector<DeepSample>& samples) const {
    double before = 1;
    for (const DeepLayer& layer : layers_) {
        if (!(before > 0)) break;
        DeepSample sample{depth(layer.begin), depth(layer.end), {}, 0};
        sample.alpha = static_cast<float>(std::clamp(1 - layer.transmittance / before, 0.0, 1.0));
        const LinearRgb rgb =
            rendering_.colour(layer.light * (pixel_.result.pixel_factor / before));
        for (std::size_t c = 0; c < rgb.size(); ++c) sample.colour[c] = static_cast<float>(rgb[c]);
        before *= 1 - static_cast<double>(sample.alpha);
        if (sample.alpha > 0 || sample.colour != std::array<float, 3>{}) samples.push_back(sample);
    }
}

void DeepPixel::make(std::vector<DeepSample>& samples) {
    if (!(depth(1) > depth(0)))
        throw InputError(
            "--deep: the camera sees more than what is before it, where depth along its axis does "
            "not order what it sees; use a lens of less than 180 degrees, or --crop");
    choose_ends();
    make_layers();
    add_lamps();
    merge(static_cast<std::size_t>(rendering_.deep->most()));
    store(samples);
}

}  // namespace

void DeepPass::begin(Rendering& rendering) {
    if (rendering.deep == nullptr) return;
    const auto attenuation =
        std::make_shared<const AttenuationTable>(*rendering.pixels.scene().medium);
    rendering.steps.emplace_back([&rendering, attenuation](const RenderedPixel& pixel) {
        std::vector<DeepSample>& samples = rendering.deep->pixel(pixel.x, pixel.y);
        samples.clear();
        if (pixel.view.ray) DeepPixel(rendering, *attenuation, pixel).make(samples);
    });
}

}  // namespace uw
