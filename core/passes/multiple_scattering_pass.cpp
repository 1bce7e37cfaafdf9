#include "core/passes/multiple_scattering_pass.h"

#include <algorithm>
#include <cmath>

#include "core/passes/camera_radiance_cache.h"
#include "core/passes/error_sums.h"
#include "core/passes/multiple_scattering.h"

namespace uw {

namespace {

// These give a standard error of less than 1 % where light crosses an optical depth of about one,
// and of 5 % for drafts. Small images need fewer nodes.
RadianceCacheOptions options_of(RenderDesc::Quality quality, double pixels) {
    constexpr double k_pixels_of_node = 4, k_paths_of_node = 120;
    RadianceCacheOptions options;
    options.nodes = static_cast<int>(std::clamp(pixels / k_pixels_of_node, 1000.0, 5000.0));
    options.cells = 1'000'000;
    options.paths = static_cast<int>(k_paths_of_node * options.nodes);
    options.error = 0.012;
    if (quality == RenderDesc::Quality::draft) {
        options.nodes = 1000;
        options.cells = 100'000;
        options.paths = 30'000;
        options.error = 0;
    }
    if (quality == RenderDesc::Quality::exact) {
        options.nodes = 20000;
        options.cells = 4'000'000;
        options.paths = 16'000'000;
        options.error = 0;
    }
    return options;
}

// Whether there is any light to be scattered, and paths to find it by.
bool is_lit(const PixelRenderer& pixels) {
    return pixels.transport().paths &&
           (!pixels.scene().emitters->empty() || pixels.scene().surfaces->may_emit());
}

}  // namespace

MultipleScatteringPass::MultipleScatteringPass(double path_factor)
    : Pass(Stage::multiple_scattering), path_factor_(path_factor) {}
MultipleScatteringPass::~MultipleScatteringPass() = default;

PassNeeds MultipleScatteringPass::needs(const LayerPlan& /*plan*/) const {
    return {.paths = true};
}

void MultipleScatteringPass::provide(LayerSupply& supply) const {
    supply.layers |=
        {Layer::multiple, Layer::multiple_volume, Layer::multiple_surface, Layer::error};
}

void MultipleScatteringPass::begin(Rendering& rendering) {
    light_.reset();
    sums_.reset();
    if (!is_lit(rendering.pixels)) return;
    rendering.steps.emplace_back([this](const RenderedPixel& pixel) {
        light_->add(pixel.view, pixel.light, pixel.first_sample, pixel.result);
        sums_->add(pixel);
    });
    rendering.multiple_up_to = [this](const PixelView& view, double distance) {
        return light_->light_of_water(view, distance);
    };
}

std::shared_ptr<const CameraRadianceCache> MultipleScatteringPass::trace(
    Rendering& rendering) const {
    const RaySource& rays = rendering.pixels.rays();
    RadianceCacheOptions options = options_of(rendering.desc.render.quality,
                                              static_cast<double>(rays.width()) * rays.height());
    options.paths = static_cast<int>(options.paths * path_factor_);
    options.error /= std::sqrt(path_factor_);
    options.lamps = rendering.plan.has_lamps();
    return std::make_shared<CameraRadianceCache>(rendering.pixels, options, rendering.film.window(),
                                                 rendering.progress_of(*stage()));
}

void MultipleScatteringPass::share(Rendering& middle) {
    shared_.reset();
    if (is_lit(middle.pixels)) shared_ = trace(middle);
}

void MultipleScatteringPass::run(Rendering& rendering) {
    const PixelRenderer& pixels = rendering.pixels;
    if (!is_lit(pixels)) return;
    const PixelWindow& window = rendering.film.window();
    if (rendering.is_shared && shared_)
        light_ =
            std::make_unique<MultipleScattering>(pixels, shared_, window, shared_->halo_at(pixels));
    else
        light_ = std::make_unique<MultipleScattering>(pixels, trace(rendering), window);
    sums_ = std::make_unique<ErrorSums>(window, pixels.rays().height(),
                                        static_cast<std::size_t>(pixels.band_count()));
}

void MultipleScatteringPass::end(Rendering& rendering) {
    if (sums_) sums_->report(rendering.reached);
}

}  // namespace uw
