#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/troubleshooting.h"
#include "core/image/colour.h"
#include "core/light/integrator_table.h"
#include "core/passes/pixel_layers.h"
#include "render/exposure.h"
#include "render/mirror_image.h"
#include "render/scene_assembly.h"

namespace uw {

namespace {

// The estimated standard error of their parts above which final images come with a warning.
constexpr double k_max_multiple_error = 0.03;

PixelWindow whole_image(const CameraDesc& camera) {
    return {0, 0, camera.width, camera.height};
}

void check_window(const PixelWindow& window, const CameraDesc& camera) {
    if (window.x0 < 0 || window.y0 < 0 || window.x0 >= window.x1 || window.y0 >= window.y1 ||
        window.x1 > camera.width || window.y1 > camera.height)
        throw UsageError(fmt::format("{},{},{},{}: not a window of the image of {} x {} pixels",
                                     window.x0, window.y0, window.x1, window.y1, camera.width,
                                     camera.height));
}

/// Returns a warning if every pixel of the sensor is saturated.
std::optional<std::string> saturation_warning(const CameraDesc& camera, const LayerPlan& plan,
                                              Film& film) {
    if (!camera.sensor || !plan.has(Layer::sensor)) return std::nullopt;
    const SensorDesc& sensor = *camera.sensor;
    double least = sensor.white_level();
    if (sensor.full_well) {
        // The digital number of a full well varies by the noise of reading it, and is rounded.
        constexpr double k_deviations = 5, k_rounding = 0.5;
        const double gain = sensor.system_gain();
        const double added = gain * std::hypot(sensor.read_noise, sensor.dsnu);
        const double full = gain * *sensor.full_well + sensor.black_level;
        least = std::min(least, std::max(full - k_deviations * added - k_rounding,
                                         0.5 * (full + sensor.black_level)));
    }
    const PixelWindow& window = film.window();
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            for (const float number : plan.channels(Layer::sensor, film.pixel(x, y)))
                if (static_cast<double>(number) < least) return std::nullopt;
    return fmt::format(
        "{}: every pixel of the image is saturated, so that it shows nothing; make the exposure "
        "shorter than {:g} s, or the lamps dimmer",
        sensor.where, *sensor.exposure);
}

}  // namespace

void Renderer::begin(Stage stage) const {
    progress_(stage, 0);
    throw_if_stopped();
}

void Renderer::set_scene(ImageScene scene) {
    scene_.reset();
    image_ = std::move(scene);
    light_.clear();
    colour_.reset();
}

void Renderer::set_scene(AssembledScene scene) {
    set_scene(scene.image);
    scene_ = std::move(scene);
}

void Renderer::build() {
    if (!scene_)
        scene_ = assemble_scene(
            *image_, cache_, [this](Stage stage) { begin(stage); },
            [this](double fraction) { progress_(Stage::particles, fraction); });
}

const AssembledScene& Renderer::assemble() {
    build();
    if (!scene_->slabs) scene_->slabs = place_slabs(*scene_);
    return *scene_;
}

// Uses the resolution for the scene that was set, although `scene` may be that of a part of its
// exposure.
DeepShadows Renderer::light_of(const AssembledScene& scene, const ProgressCallback& progress) {
    DeepShadows light = cache_.light(
        scene, deep_shadow_options(scene_->desc().render.quality, scene_->water.medium), progress);
    splat_rays_ += cache_.splat_counts().rays;
    return light;
}

const DeepShadows& Renderer::splat() {
    build();
    if (light_.empty()) {
        begin(Stage::splat);
        light_ = light_of(*scene_, [this](double fraction) { progress_(Stage::splat, fraction); });
    }
    return light_;
}

LightTransport Renderer::make_transport() {
    assemble();
    const PassNeeds needs = make_passes(*image_).needs(layer_plan(*image_, {}));
    if (needs.light) splat();
    return make_light_transport(*scene_, light_, needs.paths);
}

std::optional<LightLeftOut> Renderer::light_left_out() {
    build();
    return estimate_light_left_out(*scene_);
}

void Renderer::drop_light() {
    cache_.drop_light();
    light_.clear();
}

void Renderer::fit_film(const RenderOptions& options) {
    const CameraDesc& camera = image_->desc().camera;
    window_ = options.window.value_or(whole_image(camera));
    check_window(window_, camera);
    const PixelWindow rendered = needs_.whole_image ? whole_image(camera) : window_;
    cropped_.reset();
    if (film_ && film_->width() == camera.width && film_->height() == camera.height &&
        film_->window() == rendered && film_->channel_names() == plan_->channel_names()) {
        if (!is_film_clear_) film_->clear();
    } else {
        film_.reset();  // frees the memory
        film_.emplace(camera.width, camera.height, rendered, plan_->channel_names());
    }
    is_film_clear_ = true;
    deep_.reset();
    if (options.deep > 0) deep_.emplace(camera.width, camera.height, rendered, options.deep);
}

void Renderer::prepare(const RenderOptions& options) {
    report_ = {};
    const SceneDesc& desc = image_->desc();
    plan_ = layer_plan(*image_, options.layers, options.paths);
    if (!colour_) colour_ = make_band_colour(desc.render.colour, desc.water.bands_nm);
    passes_ = make_passes(*image_, options.paths, options.frame);
    passes_.prepare(desc, *plan_);
    needs_ = passes_.needs(*plan_);
    fit_film(options);
    report_.pixels = static_cast<std::uint64_t>(film_->window().width()) *
                     static_cast<std::uint64_t>(film_->window().height());
    if (needs_.slabs)
        assemble();
    else
        build();
    if (options.deep > 0) check_deep(*scene_);
    if (!colour_->warning().empty()) report_.warnings.push_back(colour_->warning());
    report_.warnings.insert(report_.warnings.end(), scene_->warnings.begin(),
                            scene_->warnings.end());
    if (const auto warning = far_lamp_warning(*scene_)) report_.warnings.push_back(*warning);
}

void Renderer::count_work() {
    const auto samples = static_cast<std::uint64_t>(samples_of(scene_->desc().render));
    // One ray per sample, and one more through the pixel's centre, for in-scattering and ground
    // truth, unless that is the only sample.
    report_.camera_rays = report_.pixels * (samples == 1 ? 1 : samples + 1);
    if (report_.paths.samples > 0)
        report_.camera_rays = report_.pixels * static_cast<std::uint64_t>(report_.paths.samples);
    report_.camera_rays *= report_.colour_groups;
    report_.splat_rays = std::exchange(splat_rays_, 0);
    for (const auto& field : light_) report_.light_bytes += field->bytes();
    for (const VolumeReport& volume : scene_->volume_reports) {
        report_.active_voxels += static_cast<std::uint64_t>(volume.statistics.active_voxels);
        report_.grid_bytes += volume.bytes;
    }
    report_.triangles = scene_->surfaces->triangle_count();
    report_.lamps = scene_->lamps.size();
    report_.bands = static_cast<std::uint64_t>(scene_->water.medium.band_count());
}

void Renderer::warn_of_error(const PathRequest& request) {
    if (!request.error || !(report_.paths.error > *request.error)) return;
    report_.warnings.push_back(fmt::format(
        "--error {:g}: {} samples per pixel, the most there are, leave a standard error of {:.3g} "
        "of the image's mean; this is the image written",
        *request.error, report_.paths.samples, *report_.paths.error));
}

void Renderer::warn_of_multiple_error() {
    const RenderDesc::Quality quality = scene_->desc().render.quality;
    if (quality == RenderDesc::Quality::draft ||
        !(report_.multiple_error_of_parts > k_max_multiple_error))
        return;
    const char* const better = quality == RenderDesc::Quality::exact ? "" : "--quality exact, or ";
    report_.warnings.push_back(fmt::format(
        "multiple scattering: its standard error is {:.2g} % of the light in each part of the "
        "image, "
        "{:.2g} % in the worst; for less, use {}--integrator path with --error 0.02{}",
        100 * report_.multiple_error_of_parts, 100 * report_.multiple_error_of_worst_part, better,
        see_troubleshooting("Blotches, grain and spots")));
}

StageProgressCallback Renderer::progress_of_group(std::size_t group, std::size_t groups) const {
    if (groups == 1) return progress_;
    return [this, group, groups](Stage stage, double fraction) {
        const double done = fraction_of_pixels(stage, fraction);
        progress_(Stage::render, (static_cast<double>(group) + done) / static_cast<double>(groups));
    };
}

void Renderer::render_light(const Exposure& exposure, const AssembledScene& scene, PassList& passes,
                            Rendering& rendering) {
    if (exposure.part_count() == 0) {
        run_light_passes(scene, passes, rendering);
        return;
    }
    render_exposure(
        exposure, scene, cache_, passes,
        [this](const AssembledScene& part) {
            return needs_.light ? light_of(part, [](double) {}) : DeepShadows();
        },
        rendering);
}

// Renders the groups of bands whose rays the port refracts differently. Each is an image by itself,
// whose bands are copied to the film. Everything but the camera is that of the first group.
void Renderer::render_other_groups(std::span<const ColourGroup> groups,
                                   const RenderOptions& options, PassList& passes) {
    for (std::size_t k = 1; k < groups.size(); ++k) {
        ImageScene image = scene_->image.with(
            [&](SceneDesc& desc) { set_wavelength(desc.camera, groups[k].wavelength_nm); });
        auto camera = std::make_unique<Camera>(image.desc().camera);
        const AssembledScene scene =
            with_moved(*scene_, std::move(image), std::move(camera), cache_);
        LightTransport own;
        if (!options.transport) own = make_light_transport(scene, light_, needs_.paths);
        const BandColour colour = colour_->of(groups[k].bands);
        const StageProgressCallback progress = progress_of_group(k, groups.size());
        Film film(film_->width(), film_->height(), film_->window(), film_->channel_names());
        ImageProgress reached;
        Rendering rendering =
            make_rendering(scene, *scene.camera, options.transport ? *options.transport : own,
                           light_, {*plan_, colour, film, progress, reached});
        render_light(Exposure(scene), scene, passes, rendering);
        take_bands(film, groups[k].bands, *plan_, *film_);
        report_.include(reached);
    }
}

void Renderer::render_film(const RenderOptions& options, PassList& passes) {
    LightTransport own;
    if (!options.transport) own = make_light_transport(*scene_, light_, needs_.paths);
    const LightTransport& transport = options.transport ? *options.transport : own;
    const Correspondences others(*scene_, *plan_, cache_);
    report_.warnings.insert(report_.warnings.end(), others.warnings().begin(),
                            others.warnings().end());
    const Exposure exposure(*scene_);
    report_.exposure_parts = static_cast<std::uint64_t>(exposure.part_count());
    report_.exposure_samples = static_cast<std::uint64_t>(exposure.samples());
    report_.motion_pixels = exposure.motion_pixels();
    if (exposure.part_count() > 0 && options.paths.error)
        throw UsageError(
            "--error: is not known of an image in which something moves while the shutter is "
            "open; give --samples instead");
    if (exposure.part_count() > 0 && options.deep > 0)
        throw UsageError(
            "--deep: something moves while the shutter is open, so that a pixel has no one place "
            "for its light; give --set render.shutter=0, and no camera.line_time");
    const std::vector<ColourGroup> groups = colour_groups_of(scene_->desc());
    if (groups.size() > 1 && options.deep > 0)
        throw UsageError(
            "--deep: the port bends each wavelength along its own way, but a deep pixel has one; "
            "give the port the same indices at all wavelengths");
    report_.colour_groups = groups.size();
    const BandColour colour = groups.size() > 1 ? colour_->of(groups.front().bands) : *colour_;
    const StageProgressCallback progress = progress_of_group(0, groups.size());
    Rendering rendering = make_rendering(
        *scene_, *scene_->camera, transport, light_,
        {*plan_, colour, *film_, progress, report_, deep_ ? &*deep_ : nullptr}, others.matchers());
    render_light(exposure, *scene_, passes, rendering);
    render_other_groups(groups, options, passes);
    passes.run(Pass::Of::image, rendering);
}

const Film& Renderer::render(const RenderOptions& options) {
    prepare(options);
    if (needs_.light)
        splat();
    else
        begin(Stage::splat);
    is_film_clear_ = false;
    PassList passes = std::exchange(passes_, {});  // frees their memory at the end
    render_film(options, passes);
    warn_of_error(options.paths);
    warn_of_multiple_error();
    if (const auto warning = saturation_warning(scene_->desc().camera, *plan_, *film_))
        report_.warnings.push_back(*warning);
    count_work();
    if (film_->window() == window_) return *film_;
    cropped_ = cropped(*film_, window_);
    return *cropped_;
}

Film Renderer::release_film() {
    std::optional<Film>& film = cropped_ ? cropped_ : film_;
    Film released = std::move(*film);
    film.reset();
    return released;
}

}  // namespace uw
