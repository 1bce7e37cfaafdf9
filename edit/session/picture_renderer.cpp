#include "edit/session/picture_renderer.h"

#include <algorithm>
#include <array>
#include <exception>
#include <utility>

#include "camera/camera.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/light/integrator_table.h"
#include "edit/session/picture.h"
#include "render/light_left_out.h"

namespace uw {

namespace {

constexpr std::array<PictureQuality, k_picture_qualities> k_steps{
    PictureQuality::first, PictureQuality::small, PictureQuality::draft, PictureQuality::full_draft,
    PictureQuality::final};
// The key of what no lamp lights; no lamp has it.
constexpr const char* k_unlit = "unlit";

// A lamp's image serves any brightness of it, unless it is rendered in the dark.
void light_up(LampDesc& lamp, const Spectrum& brightness, std::size_t bands) {
    if (lamp.is_of_scene() || brightness.least(bands) > 0) return;
    lamp.spectrum.reset();
    lamp.power.reset();
    lamp.lumens.reset();
    lamp.intensity.reset();
    if (!std::visit([](const auto& profile) { return profile.k_is_absolute; }, lamp.profile))
        lamp.intensity = PerBand(bands, 1);
}

bool has_all_light(const EditedScene& scene) {
    return scattering_of(scene.scene.desc().render) == RenderDesc::Scattering::multiple;
}

std::string layers_of(const ImageScene& scene, bool is_lit) {
    std::string layers = "direct,clean";
    layers += is_lit ? ",backscatter,irradiance" : ",depth,albedo";
    const LayerPlan plan = layer_plan(scene, {});
    if (plan.is_provided(Layer::forward)) layers += ",forward";
    if (plan.is_provided(Layer::snow)) layers += ",snow";
    if (plan.is_provided(Layer::multiple)) layers += ",multiple,multiple.volume,multiple.surface";
    return layers;
}

ImageScene scene_of_part(const EditedScene& edited, PictureQuality quality,
                         std::optional<std::size_t> lamp) {
    return edited.scene.with([&](SceneDesc& desc) {
        LampDesc only;
        if (lamp) only = desc.lamps[*lamp];
        desc.lamps.clear();
        if (lamp) {
            light_up(only, edited.lamps[*lamp].brightness, edited.bands());
            desc.lamps.push_back(std::move(only));
        }
        const auto [width, height] = picture_size(quality, desc.camera.width, desc.camera.height);
        resize_image(desc.camera, width, height);
        if (quality == PictureQuality::first) {
            desc.render.integrator = RenderDesc::Integrator::volume;
            desc.render.scattering = RenderDesc::Scattering::single;
        }
        if (quality != PictureQuality::final) {
            desc.render.quality = RenderDesc::Quality::draft;
            desc.render.samples = integrator_kind(desc.render.integrator).draft_samples;
        }
    });
}

// The contribution of a part of a picture by light paths, in units common to all parts.
// `brightness`: of its lamp now, to which it is linear; null: it has none.
double path_light(const LightLayers& layers, const Spectrum* brightness) {
    if (!layers.plan.has(Layer::multiple)) return 0;
    const std::size_t channels = layers.film.channel_names().size();
    const auto first = static_cast<std::size_t>(layers.plan.first_channel(Layer::multiple));
    const auto bands = static_cast<std::size_t>(layers.plan.band_count());
    double sum = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        const double rendered = layers.brightness[b];
        const double factor = !brightness ? 1 : rendered > 0 ? (*brightness)[b] / rendered : 0;
        for (std::size_t at = first + b; at < layers.film.values().size(); at += channels)
            sum += factor * static_cast<double>(layers.film.values()[at]);
    }
    return std::max(0.0, sum);
}

// Surfaces that emit light do so beside every lamp, but that light belongs to the unlit part.
void take_away_emission(LightLayers& light, const LightLayers& unlit) {
    for (const Layer layer :
         {Layer::direct, Layer::forward, Layer::multiple, Layer::multiple_volume,
          Layer::multiple_surface, Layer::snow, Layer::clean}) {
        if (!light.plan.has(layer)) continue;
        const auto to = static_cast<std::size_t>(light.plan.first_channel(layer));
        const auto from = static_cast<std::size_t>(unlit.plan.first_channel(layer));
        const auto bands = static_cast<std::size_t>(light.plan.band_count());
        for (int y = 0; y < light.film.height(); ++y)
            for (int x = 0; x < light.film.width(); ++x)
                for (std::size_t b = 0; b < bands; ++b)
                    light.film.pixel(x, y)[to + b] -= unlit.film.pixel(x, y)[from + b];
    }
}

}  // namespace

PictureRenderer::PictureRenderer(PictureCallbacks callbacks)
    : callbacks_(std::move(callbacks)),
      renderer_([this](Stage stage, double fraction) {
          if (stage == Stage::render && callbacks_.progress)
              callbacks_.progress(
                  quality_, (static_cast<double>(part_) + fraction) / static_cast<double>(parts_));
      }),
      thread_([this] { run(); }) {}

PictureRenderer::~PictureRenderer() {
    {
        const std::lock_guard lock(mutex_);
        is_stopping_ = is_outdated_ = true;
        changed_.notify_all();
    }
    thread_.join();
}

void PictureRenderer::show(std::shared_ptr<const EditedScene> scene) {
    const std::lock_guard lock(mutex_);
    if (current_ && !is_same_picture(*current_, *scene)) is_outdated_ = true;
    next_ = std::move(scene);
    changed_.notify_all();
}

std::shared_ptr<const Picture> PictureRenderer::picture() const {
    const std::lock_guard lock(mutex_);
    return picture_;
}

void PictureRenderer::run() {
    work_in_background();  // the browser that shows the pictures comes first
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return is_stopping_ || next_; });
        if (is_stopping_) return;
        current_ = std::exchange(next_, nullptr);
        is_outdated_ = false;
        const std::shared_ptr<const EditedScene> scene = current_;
        lock.unlock();
        try {
            render_all(scene);
        } catch (const Interrupted&) {
            // There is a newer scene, or no further one.
        } catch (const std::exception& error) {
            callbacks_.failed(line_of(error));
        }
        lock.lock();
    }
}

bool PictureRenderer::has_next() const {
    const std::lock_guard lock(mutex_);
    return is_stopping_ || next_;
}

void PictureRenderer::render_all(const std::shared_ptr<const EditedScene>& scene) {
    forget(*scene);
    std::size_t step = k_steps.size();
    while (step > 0 && !is_known(*scene, k_steps[step - 1])) --step;
    if (step > 0) publish(scene, k_steps[step - 1]);
    if (step == k_steps.size()) estimate_light_left_out(*scene);
    for (; step < k_steps.size() && !has_next(); ++step) {
        const PictureQuality quality = k_steps[step];
        if (!is_step(*scene, quality)) continue;
        // It takes a few hundredths of the time of the picture that is left.
        if (quality == PictureQuality::final) estimate_light_left_out(*scene);
        make(scene, quality);
        publish(scene, quality);
    }
}

// All lamps matter to it, as bright as they are: it is asked anew where no picture is.
void PictureRenderer::estimate_light_left_out(const EditedScene& scene) {
    renderer_.set_scene(lit_scene(scene));
    const StopScope scope(is_outdated_);
    const auto left_out = renderer_.light_left_out();
    callbacks_.light_left_out(scene, left_out_note(renderer_.assembled(), left_out).value_or(""));
}

// Keeps what the scene's pictures are made of, and no more: memory stays the same however long a
// lamp is dragged.
void PictureRenderer::forget(const EditedScene& scene) {
    const bool is_other = surrounding_ != scene.surrounding;
    surrounding_ = scene.surrounding;
    is_announced_ = is_announced_ && !is_other;
    for (auto& layers : known_) {
        std::erase_if(layers, [&](const Layers& known) {
            return is_other || (known->key != k_unlit &&
                                std::ranges::find(scene.lamps, known->key, &EditedLamp::key) ==
                                    scene.lamps.end());
        });
    }
}

PictureRenderer::Layers PictureRenderer::find(PictureQuality quality,
                                              const std::string& key) const {
    const auto& layers = known_[static_cast<std::size_t>(quality)];
    const auto found =
        std::ranges::find_if(layers, [&](const Layers& known) { return known->key == key; });
    if (found != layers.end()) return *found;
    // A lamp that has not changed is final already while the others' drafts are rendered.
    return quality == PictureQuality::full_draft ? find(PictureQuality::final, key) : nullptr;
}

bool PictureRenderer::is_known(const EditedScene& scene, PictureQuality quality) const {
    return find(quality, k_unlit) && std::ranges::all_of(scene.lamps, [&](const EditedLamp& lamp) {
               return find(quality, lamp.key) != nullptr;
           });
}

// Whether a picture of this quality is rendered before the final one.
bool PictureRenderer::is_step(const EditedScene& scene, PictureQuality quality) const {
    const auto size_of = [&](PictureQuality other) {
        const CameraDesc& camera = scene.scene.desc().camera;
        return picture_size(other, camera.width, camera.height);
    };
    // A small image needs no smaller ones before it.
    const auto is_as_large_as = [&](PictureQuality next) {
        return size_of(quality) == size_of(next);
    };
    switch (quality) {
        case PictureQuality::first: {
            const auto shown = picture();
            return has_all_light(scene) &&
                   (!shown || shown->scene->surrounding != scene.surrounding);
        }
        case PictureQuality::small:
            return !is_as_large_as(PictureQuality::draft);
        case PictureQuality::draft:
            // All light takes nearly as long at this size as at the full one.
            return !has_all_light(scene) && !is_as_large_as(PictureQuality::full_draft);
        case PictureQuality::full_draft:
        case PictureQuality::final:
            break;
    }
    return true;
}

// Of the light paths that `render` takes for the whole picture, those of one part of it. In
// proportion to what it adds to the picture they leave the same noise; a faint lamp has more, as it
// may be looked at alone, and turned up.
double PictureRenderer::fraction_of_paths(const EditedScene& scene, PictureQuality quality,
                                          std::optional<std::size_t> lamp) const {
    if (quality != PictureQuality::final || !has_all_light(scene)) return 1;
    const auto light = [&](std::optional<std::size_t> part) {
        const Layers layers =
            find(PictureQuality::full_draft, part ? scene.lamps[*part].key : k_unlit);
        return path_light(*layers, part ? &scene.lamps[*part].brightness : nullptr);
    };
    double all = light(std::nullopt);
    for (std::size_t i = 0; i < scene.lamps.size(); ++i) all += light(i);
    const double even = 1 / static_cast<double>(scene.lamps.size() + 1);
    const double own = all > 0 ? light(lamp) / all : even;
    return std::max(own, 0.5 * even);
}

PictureRenderer::Layers PictureRenderer::render(const EditedScene& scene, PictureQuality quality,
                                                std::optional<std::size_t> lamp) {
    renderer_.set_scene(scene_of_part(scene, quality, lamp));
    const std::string layers = layers_of(renderer_.scene(), lamp.has_value());
    LayerPlan plan = layer_plan(renderer_.scene(), layers);
    {
        const StopScope scope(quality <= PictureQuality::small ? is_stopping_ : is_outdated_);
        renderer_.render(
            {.layers = layers, .paths = {.path_factor = fraction_of_paths(scene, quality, lamp)}});
    }
    Spectrum brightness;
    if (lamp && renderer_.scene().desc().lamps.front().is_of_scene())
        brightness = scene.lamps[*lamp].brightness;
    else if (lamp)
        brightness = renderer_.assembled().lamps.front().axis_intensity();
    if (!std::exchange(is_announced_, true)) callbacks_.assembled(renderer_);
    if (lamp) ++rendered_;
    auto light = std::make_shared<LightLayers>(LightLayers{lamp ? scene.lamps[*lamp].key : k_unlit,
                                                           renderer_.release_film(),
                                                           std::move(plan), brightness});
    if (lamp) take_away_emission(*light, *find(quality, k_unlit));
    return light;
}

void PictureRenderer::make(const std::shared_ptr<const EditedScene>& scene,
                           PictureQuality quality) {
    quality_ = quality;
    std::vector<std::optional<std::size_t>> missing;
    if (!find(quality, k_unlit)) missing.push_back(std::nullopt);  // first: lamps need it
    for (std::size_t i = 0; i < scene->lamps.size(); ++i)
        if (!find(quality, scene->lamps[i].key)) missing.push_back(i);
    parts_ = missing.size();
    for (part_ = 0; part_ < parts_; ++part_) {
        const auto lamp = missing[part_];
        // Two lamps may be alike.
        if (lamp && find(quality, scene->lamps[*lamp].key)) continue;
        known_[static_cast<std::size_t>(quality)].push_back(render(*scene, quality, lamp));
    }
    if (quality == PictureQuality::small)
        known_[static_cast<std::size_t>(PictureQuality::first)].clear();
    if (quality == PictureQuality::final)
        known_[static_cast<std::size_t>(PictureQuality::full_draft)].clear();
}

void PictureRenderer::publish(const std::shared_ptr<const EditedScene>& scene,
                              PictureQuality quality) {
    auto made = std::make_shared<Picture>();
    made->quality = quality;
    made->scene = scene;
    for (const EditedLamp& lamp : scene->lamps) made->lamps.push_back(find(quality, lamp.key));
    made->unlit = find(quality, k_unlit);
    made->width = made->unlit->film.width();
    made->height = made->unlit->film.height();
    {
        const std::lock_guard lock(mutex_);
        // The same light gives the same picture, whatever the current names of lamps.
        const bool is_same =
            picture_ && picture_->lamps == made->lamps && picture_->unlit == made->unlit;
        made->number = is_same ? last_number_ : ++last_number_;
        picture_ = made;
        if (is_same) return;
    }
    callbacks_.done(*made);
}

}  // namespace uw
