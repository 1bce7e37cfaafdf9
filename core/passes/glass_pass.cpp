#include "core/passes/glass_pass.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/passes/glass_view.h"
#include "core/passes/pixel_terms.h"
#include "core/paths/path_tracer.h"

namespace uw {

namespace {

// Differs from the seeds of other random numbers.
constexpr std::uint64_t k_glass_seed = 0x676c617373;

// The light paths of each kind in a pixel, distributed over its legs by their weight; draft,
// others. The grain of 32 is a few percent of the light that paths bring.
constexpr double k_draft_paths = 4, k_paths = 32;

/// Adds contributions to a pixel, times a weight per band.
class WeightedPixel final : public ContributionSink {
  public:
    WeightedPixel(PixelResult& pixel, std::size_t bands) : pixel_(pixel), bands_(bands) {}

    void set(Spectrum PixelResult::*part, const Spectrum& weight, double factor) {
        part_ = part;
        weight_ = weight * factor;
    }
    void add(const PathContribution& contribution) override {
        const bool is_of_lamp = contribution.lamp != k_no_lamp && !pixel_.lamps.empty();
        for (std::size_t b = 0; b < bands_; ++b) {
            const double radiance = weight_[b] * contribution.radiance[b];
            (pixel_.*part_)[b] += radiance;
            if (is_of_lamp) pixel_.lamps[contribution.lamp][b] += radiance;
        }
    }

  private:
    PixelResult& pixel_;
    std::size_t bands_;
    Spectrum PixelResult::*part_ = &PixelResult::direct;
    Spectrum weight_;
};

}  // namespace

/// Finds the light of legs.
class GlassLight {
  public:
    GlassLight(const PixelRenderer& pixels, bool multiple, double paths)
        : pixels_(pixels),
          view_(pixels.scene()),
          bands_(static_cast<std::size_t>(pixels.band_count())),
          paths_(multiple && pixels.transport().paths ? paths : 0) {}

    /// Adds the light of a pixel. Thread safe.
    void add(const RenderedPixel& pixel) const;

  private:
    struct Sample {
        const SurfaceSample* sample;
        std::vector<GlassLeg> legs;
    };

    void add_surfaces(std::span<const Sample> samples, PixelResult& result) const;
    void add_lamps(const GlassLeg& leg, double weight, PixelResult& result) const;
    void add_water(const GlassLeg& leg, double weight, PixelResult& result) const;
    void add_paths(const GlassLeg& leg, double weight, PathRandom& random,
                   PixelResult& result) const;

    const PixelRenderer& pixels_;
    GlassView view_;
    std::size_t bands_;
    double paths_;
};

void GlassLight::add(const RenderedPixel& pixel) const {
    std::vector<Sample> samples;
    const PixelView& view = pixel.view;
    const Sample* of_water = nullptr;
    for (const SurfaceSample& sample : view.samples)
        if (sample.hit.glass != 0) samples.push_back({&sample, {}});
    if (samples.empty()) return;
    for (Sample& each : samples) {
        view_.follow(each.sample->ray, each.sample->hit, each.legs);
        // The one nearest to the pixel's centre.
        const auto offset = [&](const Sample& of) {
            const double x = of.sample->x - view.x, y = of.sample->y - view.y;
            return x * x + y * y;
        };
        if (of_water == nullptr || offset(each) < offset(*of_water)) of_water = &each;
    }
    PixelResult& result = pixel.result;
    const double weight = 1.0 / pixels_.samples();
    const double fraction = weight * static_cast<double>(samples.size());
    add_surfaces(samples, result);
    for (const Sample& each : samples)
        for (const GlassLeg& leg : each.legs) add_lamps(leg, weight, result);
    for (const GlassLeg& leg : of_water->legs) add_water(leg, fraction, result);
    if (paths_ == 0) return;
    PathRandom random(PathRandom::seed_of(k_glass_seed, static_cast<std::uint64_t>(pixel.y) << 32U |
                                                            static_cast<std::uint64_t>(pixel.x)),
                      static_cast<std::uint32_t>(pixels_.first_sample()));
    for (const Sample& each : samples)
        for (const GlassLeg& leg : each.legs) add_paths(leg, weight, random, result);
}

void GlassLight::add_surfaces(std::span<const Sample> samples, PixelResult& result) const {
    std::vector<SurfaceSample> seen;
    std::vector<const GlassLeg*> legs;
    for (const Sample& each : samples)
        for (const GlassLeg& leg : each.legs) {
            if (!leg.has_hit || leg.hit.glass != 0) continue;
            seen.push_back({leg.ray, leg.hit, each.sample->x, each.sample->y});
            legs.push_back(&leg);
        }
    std::vector<const SurfaceSample*> surfaces;
    for (const SurfaceSample& sample : seen) surfaces.push_back(&sample);
    SurfaceLight light;
    pixels_.transport().surfaces->evaluate(surfaces, light);
    WeightedPixel sum(result, bands_);
    const double weight = 1.0 / pixels_.samples();
    for (std::size_t i = 0; i < seen.size(); ++i) {
        std::ranges::copy(legs[i]->left.first(bands_), light.to_camera(i).begin());
        sum.set(&PixelResult::direct, legs[i]->weight, weight);
        Spectrum leaving;
        add_direct_light(pixels_.scene(), seen[i], light, i, sum, leaving);
        result.clean += weight * (legs[i]->clear * leaving);
    }
}

void GlassLight::add_lamps(const GlassLeg& leg, double weight, PixelResult& result) const {
    std::vector<SeenLamp> lamps;
    pixels_.lamps_in_view().append(leg.ray, leg.has_hit ? leg.hit.distance : k_far, lamps);
    WeightedPixel sum(result, bands_);
    for (const SeenLamp& lamp : lamps) {
        const Spectrum& arriving = leg.is_in_water ? lamp.arriving : lamp.radiance;
        sum.set(&PixelResult::direct, leg.weight, weight);
        sum.add({.lamp = lamp.lamp, .radiance = arriving.first(bands_)});
        result.lamps_in_view += weight * (leg.weight * arriving);
        result.clean += weight * (leg.clear * lamp.radiance);
        if (!lamp.is_volume) result.shows_lamp = true;
    }
}

void GlassLight::add_water(const GlassLeg& leg, double weight, PixelResult& result) const {
    if (!leg.is_in_water) return;
    const std::array distances{leg.has_hit ? leg.hit.distance : k_far};
    InScatter light;
    pixels_.transport().integrator->in_scatter(leg.ray, distances, light);
    WeightedPixel sum(result, bands_);
    sum.set(&PixelResult::backscatter, leg.weight, weight);
    for (std::size_t lamp = 0; lamp < light.lamp_count(); ++lamp)
        sum.add({.lamp = lamp, .radiance = std::as_const(light).at(0, lamp).first(bands_)});
}

void GlassLight::add_paths(const GlassLeg& leg, double weight, PathRandom& random,
                           PixelResult& result) const {
    if (!leg.is_in_water) return;
    // What is left of whole paths decides whether there is one more.
    const double mean = paths_ * weight * leg.clear.greatest(bands_);
    const int count = static_cast<int>(mean + random.next());
    if (count == 0) return;
    const PathTracer& tracer = *pixels_.transport().paths;
    CameraSegment segment;
    tracer.begin(leg.ray, leg.has_hit ? &leg.hit : nullptr, {}, segment);
    WeightedPixel sum(result, bands_);
    for (int i = 0; i < count; ++i) {
        sum.set(&PixelResult::multiple_volume, leg.weight, weight / mean);
        tracer.trace_water(segment, random, sum);
        tracer.trace_lit_surfaces(segment, random, sum);
        sum.set(&PixelResult::multiple_surface, leg.weight, weight / mean);
        tracer.trace_surface(segment, random, sum);
    }
}

GlassPass::GlassPass(bool multiple) : Pass(std::nullopt), multiple_(multiple) {}
GlassPass::~GlassPass() = default;

PassNeeds GlassPass::needs(const LayerPlan& /*plan*/) const {
    return {.paths = multiple_};
}

void GlassPass::begin(Rendering& rendering) {
    light_.reset();
    if (rendering.pixels.scene().glass == nullptr) return;
    const bool is_draft = rendering.desc.render.quality == RenderDesc::Quality::draft;
    light_ = std::make_unique<GlassLight>(rendering.pixels, multiple_,
                                          is_draft ? k_draft_paths : k_paths);
    rendering.steps.emplace_back([this](const RenderedPixel& pixel) { light_->add(pixel); });
}

void GlassPass::run(Rendering& /*rendering*/) {}

}  // namespace uw
