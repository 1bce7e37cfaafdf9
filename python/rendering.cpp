#include "python/rendering.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "camera/camera.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/image/camera_sensor.h"
#include "core/image/colour_view.h"
#include "core/image/image_file.h"
#include "core/image/image_formats.h"
#include "core/image/picture_file.h"
#include "core/image/pixel_image.h"
#include "core/image/preview_exposure.h"
#include "python/bindings.h"
#include "python/scene.h"
#include "python/watched_task.h"
#include "render/derivatives/derivatives.h"
#include "render/image_header.h"
#include "render/image_scene.h"
#include "render/run/job.h"
#include "render/run/run_engine.h"
#include "render/scene_loading.h"
#include "render/validation/validation.h"

namespace py = pybind11;

namespace uw {

void save(const ImageObject& image, const std::filesystem::path& file,
          std::optional<double> exposure, const ExrOptions& options) {
    const OutputFormat* const format = output_format(file);
    if (format == nullptr)
        throw UsageError(
            fmt::format("save: {}: no format of images has this ending; give a name that ends in "
                        "{}",
                        printable(file.string(), 300), output_endings()));
    if (format->library == OutputFormat::Library::openexr) {
        write_exr(file, image.film, image.metadata, options);
        return;
    }
    require_writer(*format);
    OutputFile out(file);
    const bool wants_floats = options.precision == ExrOptions::Precision::single;
    if (format->holds == OutputFormat::Holds::light ||
        (format->holds == OutputFormat::Holds::either && wants_floats)) {
        write_light(out, image.film, image.metadata);
    } else {
        const std::shared_ptr<const ColourView> view = colour_view(image.view);
        write_picture(
            out, image.film,
            {.exposure = exposure ? *exposure : automatic_exposure(image.film).value_or(1.0),
             .view = view.get()},
            image.metadata);
    }
    out.commit();
}

namespace {

/// A view of all the film's values that keeps the image alive: rows, columns, channels.
py::array_t<float> pixels(const py::object& self) {
    const auto& film = self.cast<ImageObject&>().film;
    const PixelWindow& window = film.window();
    const auto width = static_cast<py::ssize_t>(window.width());
    const auto channels = static_cast<py::ssize_t>(film.channel_names().size());
    constexpr auto k_size = static_cast<py::ssize_t>(sizeof(float));
    return {{static_cast<py::ssize_t>(window.height()), width, channels},
            {width * channels * k_size, channels * k_size, k_size},
            film.values().data(),
            self};
}

/// A derivative (rows, columns, bands), a view that keeps the image alive.
py::array_t<float> derivative(const py::object& self, const Text& wanted) {
    const std::string& name = wanted;
    const auto& image = self.cast<ImageObject&>();
    const auto found = image.derivatives.find(name);
    if (found == image.derivatives.end())
        throw py::key_error(name + ": request it by derivatives=[...] when rendering");
    const PixelWindow& window = image.film.window();
    const std::vector<py::ssize_t> shape{window.height(), window.width(),
                                         static_cast<py::ssize_t>(image.bands_nm.size())};
    return py::array_t<float>(shape, found->second.data(), self);
}

double exposure_of(const ImageObject& image, std::optional<double> exposure) {
    return exposure ? *exposure : automatic_exposure(image.film).value_or(1.0);
}

py::array_t<std::uint8_t> srgb(const ImageObject& image, std::optional<double> exposure) {
    Preview preview;
    {
        const py::gil_scoped_release release;
        preview = make_preview(image.film, exposure_of(image, exposure));
    }
    py::array_t<std::uint8_t> pixels({preview.height(), preview.width(), 3});
    static_assert(sizeof(Srgb8) == 3);
    std::memcpy(pixels.mutable_data(), preview.values().data(), 3 * preview.size());
    return pixels;
}

py::dict report(const ImageObject& image) {
    const RenderReport& r = image.report;
    py::dict dict;
    dict["pixels"] = r.pixels;
    dict["camera_rays"] = r.camera_rays;
    dict["splat_rays"] = r.splat_rays;
    dict["light_bytes"] = r.light_bytes;
    dict["active_voxels"] = r.active_voxels;
    dict["grid_bytes"] = r.grid_bytes;
    dict["triangles"] = r.triangles;
    dict["samples"] = r.paths.samples;
    dict["error"] = r.paths.error;
    dict["multiple_error"] = r.multiple_error;
    dict["multiple_error_of_bands"] = r.multiple_error_of_bands;
    dict["multiple_error_of_parts"] = r.multiple_error_of_parts;
    dict["multiple_error_of_worst_part"] = r.multiple_error_of_worst_part;
    dict["exposure_parts"] = r.exposure_parts;
    dict["colour_groups"] = r.colour_groups;
    dict["motion_pixels"] = r.motion_pixels;
    dict["snow_particles"] = r.snow_particles;
    return dict;
}

void save_image(const ImageObject& image, const FileName& file, std::optional<double> exposure,
                const Text& wanted) {
    const std::string& precision = wanted;
    ExrOptions options;
    const auto* const found = std::ranges::find(k_precision_names, precision,
                                                [](const auto& word) { return word.first; });
    if (found == k_precision_names.end())
        throw UsageError(fmt::format("save: precision: unknown '{}'; use {}", printable(precision),
                                     alternatives(words_of(k_precision_names))));
    options.precision = found->second;
    WatchedTask task;
    run_interruptible(task, [&] { save(image, file, exposure, options); });
}

py::tuple window(const ImageObject& image) {
    const PixelWindow& w = image.film.window();
    return py::make_tuple(w.x0, w.y0, w.x1, w.y1);
}

py::tuple report_state(const RenderReport& r) {
    return py::make_tuple(r.paths.samples, r.paths.error, r.multiple_error, r.snow_particles,
                          r.warnings, r.motion_pixels,
                          std::array{r.pixels, r.camera_rays, r.splat_rays, r.light_bytes,
                                     r.active_voxels, r.grid_bytes, r.triangles, r.lamps, r.bands,
                                     r.exposure_parts, r.exposure_samples, r.colour_groups},
                          r.multiple_error_of_bands, r.multiple_error_of_parts,
                          r.multiple_error_of_worst_part);
}

RenderReport report_of_state(const py::tuple& state) {
    RenderReport r;
    r.paths = {state[0].cast<int>(), state[1].cast<std::optional<double>>()};
    r.multiple_error = state[2].cast<std::optional<double>>();
    r.snow_particles = state[3].cast<std::uint64_t>();
    r.warnings = state[4].cast<std::vector<std::string>>();
    r.motion_pixels = state[5].cast<double>();
    r.multiple_error_of_bands = state[7].cast<std::vector<double>>();
    r.multiple_error_of_parts = state[8].cast<double>();
    r.multiple_error_of_worst_part = state[9].cast<double>();
    const auto counts = state[6].cast<std::array<std::uint64_t, 12>>();
    std::size_t next = 0;
    for (std::uint64_t* count : {&r.pixels, &r.camera_rays, &r.splat_rays, &r.light_bytes,
                                 &r.active_voxels, &r.grid_bytes, &r.triangles, &r.lamps, &r.bands,
                                 &r.exposure_parts, &r.exposure_samples, &r.colour_groups})
        *count = counts[next++];
    return r;
}

py::object view_state(const std::optional<ViewDesc>& view) {
    if (!view) return py::none();
    return py::make_tuple(view->config, view->display, view->view, view->look, view->input,
                          view->where);
}

std::optional<ViewDesc> view_of_state(const py::object& state) {
    if (state.is_none()) return std::nullopt;
    const auto parts = state.cast<py::tuple>();
    return ViewDesc{parts[0].cast<std::filesystem::path>(), parts[1].cast<std::string>(),
                    parts[2].cast<std::string>(),           parts[3].cast<std::string>(),
                    parts[4].cast<std::string>(),           parts[5].cast<std::string>()};
}

py::tuple image_state(const py::object& self) {
    const auto& image = self.cast<ImageObject&>();
    py::dict derivatives;
    for (const auto& [name, values] : image.derivatives)
        derivatives[py::str(name)] = derivative(self, Text{name});
    return py::make_tuple(image.film.width(), image.film.height(), window(image),
                          image.film.channel_names(), pixels(self), image.metadata,
                          report_state(image.report), image.bands_nm, image.objects,
                          image.materials, derivatives, view_state(image.view));
}

using SavedPixels = py::array_t<float, py::array::c_style | py::array::forcecast>;

std::shared_ptr<ImageObject> image_of_state(const py::tuple& state) {
    const auto edges = state[2].cast<std::array<int, 4>>();
    const PixelWindow window{edges[0], edges[1], edges[2], edges[3]};
    Film film(state[0].cast<int>(), state[1].cast<int>(), window,
              state[3].cast<std::vector<std::string>>());
    const auto values = state[4].cast<SavedPixels>();
    if (static_cast<std::size_t>(values.size()) != film.values().size())
        throw py::value_error("an image's pixels are not those of its window");
    const float* from = values.data();
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            const std::span<float> pixel = film.pixel(x, y);
            std::copy_n(from, pixel.size(), pixel.begin());
            from += pixel.size();
        }
    auto image =
        std::make_shared<ImageObject>(ImageObject{std::move(film),
                                                  state[5].cast<ImageMetadata>(),
                                                  report_of_state(state[6].cast<py::tuple>()),
                                                  state[7].cast<std::vector<double>>(),
                                                  state[8].cast<std::map<int, std::string>>(),
                                                  state[9].cast<std::map<int, std::string>>(),
                                                  {},
                                                  view_of_state(state[11])});
    const auto pixel_count =
        static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
    for (const auto& [name, array] : state[10].cast<py::dict>()) {
        const auto saved = array.cast<SavedPixels>();
        if (static_cast<std::size_t>(saved.size()) != pixel_count * image->bands_nm.size())
            throw py::value_error("an image's derivatives are not those of its window");
        image->derivatives[name.cast<std::string>()].assign(saved.data(),
                                                            saved.data() + saved.size());
    }
    return image;
}

}  // namespace

void bind_image(py::module_& module) {
    py::class_<ImageObject, std::shared_ptr<ImageObject>>(module, "Image")
        .def_property_readonly("pixels", pixels)
        .def("derivative", derivative, py::arg("name"))
        .def_property_readonly("channels",
                               [](const ImageObject& i) { return i.film.channel_names(); })
        .def_property_readonly("window", window)
        .def_property_readonly("report", report)
        .def_readonly("bands", &ImageObject::bands_nm)
        .def_readonly("metadata", &ImageObject::metadata)
        .def_readonly("objects", &ImageObject::objects)
        .def_readonly("materials", &ImageObject::materials)
        .def_property_readonly("warnings", [](const ImageObject& i) { return i.report.warnings; })
        .def("automatic_exposure",
             [](const ImageObject& image) { return automatic_exposure(image.film); })
        .def("srgb", srgb, py::arg("exposure"))
        .def("save", save_image, py::arg("file"), py::arg("exposure"), py::arg("precision"))
        .def(py::pickle([](const py::object& image) { return image_state(image); },
                        [](const py::tuple& saved) { return image_of_state(saved); }));
}

}  // namespace uw

namespace uw {

namespace {

constexpr std::size_t k_longest_value = 80;  // in messages

/// What of a scene is rendered, and how.
struct Wanted {
    ImageRequest image;
    ImageChoice choice;
    RenderOptions options;
    std::vector<std::string> derivatives;
    int seed = 0;  // of derivatives
};

[[noreturn]] void refuse_setting(const py::dict& settings, const char* key, const char* expected) {
    throw UsageError(
        fmt::format("{}: expected {}, found {}", key, expected,
                    printable(py::repr(settings[key]).cast<std::string>(), k_longest_value)));
}

template <class T>
void take_setting(const py::dict& settings, const char* key, T& value, const char* expected) {
    if (!settings.contains(key)) return;
    try {
        value = settings[key].cast<T>();
    } catch (const py::cast_error&) {
        refuse_setting(settings, key, expected);
    }
}

Wanted wanted_of(const py::dict& settings) {
    Wanted wanted;
    const auto take = [&](const char* key, auto& value, const char* expected) {
        take_setting(settings, key, value, expected);
    };
    const char* const name = "a name";
    const char* const number = "a whole number of 0 or more";
    take("quality", wanted.image.quality, name);
    take("integrator", wanted.image.integrator, name);
    take("samples", wanted.image.samples, "a whole number of 1 or more");
    take("error", wanted.image.error, "a number");
    take("size", wanted.image.size, "(width, height) in whole pixels");
    take("layers", wanted.options.layers, "names of layers");
    take("orders", wanted.options.paths.orders, number);
    take("frame", wanted.choice.frame, "a whole number");
    take("camera", wanted.choice.camera, number);
    take("derivatives", wanted.derivatives, "names of derivatives");
    take("seed", wanted.seed, number);
    if (wanted.seed < 0) refuse_setting(settings, "seed", number);
    if (wanted.image.samples && *wanted.image.samples < 1)
        refuse_setting(settings, "samples", "a whole number of 1 or more");
    if (wanted.image.size && std::ranges::min(*wanted.image.size) < 1)
        refuse_setting(settings, "size", "(width, height) of 1 pixel or more");
    if (wanted.options.paths.orders < 0) refuse_setting(settings, "orders", number);
    wanted.options.paths.error = wanted.image.error;
    std::optional<std::array<int, 4>> crop;
    take("crop", crop, "(x0, y0, x1, y1) in whole pixels");
    if (crop) wanted.options.window = PixelWindow{(*crop)[0], (*crop)[1], (*crop)[2], (*crop)[3]};
    return wanted;
}

std::map<int, std::string> numbered(const auto& names) {
    std::map<int, std::string> result;
    for (const auto& entry : names) result[static_cast<int>(result.size()) + 1] = entry.name;
    return result;
}

ImageScene image_of(const SceneObject& scene, const Wanted& wanted) {
    SceneDesc desc = *scene.desc();
    apply_request(wanted.image, desc);
    return scene_of_image(desc, wanted.choice);
}

using Light = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// Calls `each(numbers, irradiance, colour, factor)` for all that the pixels of an image of `total`
/// light (rows, columns, bands) hold of the sensor's numbers, row by row: one each, or with three
/// values per pixel one for each colour. Returns the shape of them all.
template <class Each>
std::array<py::ssize_t, 3> visit_numbers(const SceneObject& scene, const py::dict& settings,
                                         const Light& total, const Each& each) {
    const Wanted wanted = wanted_of(settings);
    const ImageScene image = image_of(scene, wanted);
    const SceneDesc& desc = image.desc();
    if (!desc.camera.sensor)
        throw UsageError("sensor: the scene's camera has none; set camera.sensor");
    const PixelWindow window =
        wanted.options.window.value_or(PixelWindow{0, 0, desc.camera.width, desc.camera.height});
    const std::size_t bands = desc.water.bands_nm.size();
    if (total.ndim() != 3 || total.shape(0) != window.height() ||
        total.shape(1) != window.width() || static_cast<std::size_t>(total.shape(2)) != bands)
        throw UsageError("sensor: the light is not that of all pixels and bands of the image");
    const SensorMosaic mosaic = desc.camera.sensor->mosaic;
    const auto values = static_cast<std::size_t>(value_count(mosaic));
    const MeanNumbers numbers(desc);
    const Camera camera(desc.camera);
    const float* light = total.data();
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            const double factor = numbers.photoelectrons().irradiance_factor(
                camera.lens_ray(x + 0.5, y + 0.5), camera.focus_vergence());
            Spectrum irradiance;
            for (std::size_t b = 0; b < bands; ++b) irradiance[b] = factor * double{*light++};
            for (std::size_t k = 0; k < values; ++k)
                each(numbers, irradiance, values > 1 ? k : colour_at(mosaic, x, y), factor);
        }
    return {window.height(), window.width(), static_cast<py::ssize_t>(values)};
}

py::array_t<double> mean_numbers(const SceneObject& scene, const py::dict& settings,
                                 const Light& total) {
    std::vector<double> found;
    const auto shape = visit_numbers(
        scene, settings, total,
        [&](const MeanNumbers& numbers, const Spectrum& irradiance, std::size_t colour,
            double /*factor*/) { found.push_back(numbers.at(irradiance, colour)); });
    return py::array_t<double>(shape, found.data());
}

/// By the light of each band, the last axis.
py::array_t<double> number_slopes(const SceneObject& scene, const py::dict& settings,
                                  const Light& total) {
    std::vector<double> found;
    const auto bands = static_cast<std::size_t>(total.ndim() == 3 ? total.shape(2) : 0);
    const auto shape =
        visit_numbers(scene, settings, total,
                      [&](const MeanNumbers& numbers, const Spectrum& irradiance,
                          std::size_t colour, double factor) {
                          for (std::size_t b = 0; b < bands; ++b)
                              found.push_back(factor * numbers.slope(irradiance, colour, b));
                      });
    return py::array_t<double>({shape[0], shape[1], shape[2], static_cast<py::ssize_t>(bands)},
                               found.data());
}

class RendererObject : public RunClient {
  public:
    explicit RendererObject(int threads) : threads_(threads), engine_(std::in_place) {}

    std::shared_ptr<ImageObject> render(const SceneObject& scene, const py::dict& settings,
                                        const py::object& progress) {
        const std::unique_lock alone(busy_, std::try_to_lock);
        if (!alone)
            throw UsageError(
                "render: this Renderer is at work, in another thread or further up; make one for "
                "each thread");
        const Wanted wanted = wanted_of(settings);
        // NOLINTNEXTLINE(performance-unnecessary-copy-initialization): other threads may change it
        const std::shared_ptr<const SceneDesc> desc = scene.desc();
        wanted_ = &wanted;
        const py::gil_scoped_release release;
        task_.run([&] { with_threads(threads_, [&] { work(*desc); }); },
                  [&](const std::vector<WatchedTask::News>& news) { watch(news, progress); });
        return std::move(image_);
    }

    /// A change of a scene: the number's key, the scene with less and with more of it, and by how
    /// much the number differs between them.
    using Change = std::tuple<std::string, const SceneObject*, const SceneObject*, double>;

    /// The derivatives (changes, rows, columns, bands) of the image that `render` would give.
    py::array_t<float> derivatives(const SceneObject& scene, const std::vector<Change>& changes,
                                   const py::dict& settings, const py::object& progress) {
        const Wanted wanted = wanted_of(settings);
        const std::vector<ChangedScene> changed = changed_of(changes, wanted);
        const ImageScene itself = image_of(scene, wanted);
        const CameraDesc& camera = itself.desc().camera;
        const PixelWindow window =
            wanted.options.window.value_or(PixelWindow{0, 0, camera.width, camera.height});
        std::vector<float> values = differentiate(itself, progress, [&](Renderer& renderer) {
            return scene_derivatives(renderer, changed, derived(wanted), told(Stage::derivatives));
        });
        return owned(std::move(values),
                     {static_cast<py::ssize_t>(changes.size()), window.height(), window.width(),
                      static_cast<py::ssize_t>(itself.desc().water.bands_nm.size())});
    }

    /// The derivatives of a number from those by the light of the image's pixels (rows, columns,
    /// bands): by changes, by the values of the arrays of some volumes, and by the texels of the
    /// textures of some entries of geometry.
    py::tuple gradient(
        const SceneObject& scene, const std::vector<Change>& changes,
        const std::vector<std::size_t>& volumes, const std::vector<std::size_t>& textures,
        const py::array_t<double, py::array::c_style | py::array::forcecast>& weights,
        const py::dict& settings, const py::object& progress) {
        const Wanted wanted = wanted_of(settings);
        const std::vector<ChangedScene> changed = changed_of(changes, wanted);
        const ImageScene itself = image_of(scene, wanted);
        const std::span<const double> values(weights.data(),
                                             static_cast<std::size_t>(weights.size()));
        SceneGradient found = differentiate(itself, progress, [&](Renderer& renderer) {
            return scene_gradient(renderer, {changed, volumes, textures}, values, derived(wanted),
                                  told(Stage::derivatives));
        });
        py::list by_voxel, by_texel;
        for (std::size_t i = 0; i < volumes.size(); ++i) {
            std::vector<py::ssize_t> shape;
            for (const std::size_t side : itself.desc().volumes[volumes[i]].array->size)
                shape.push_back(static_cast<py::ssize_t>(side));
            by_voxel.append(owned(std::move(found.by_voxel[i]), shape));
        }
        for (std::size_t i = 0; i < textures.size(); ++i) {
            const MeshMaterial& material =
                itself.desc().geometry[textures[i]].mesh->materials.front();
            by_texel.append(owned(
                std::move(found.by_texel[i]),
                {material.base_map.texture->height(), material.base_map.texture->width(), 3}));
        }
        return py::make_tuple(py::cast(found.by_change), by_voxel, by_texel);
    }

    void clear() {
        const std::unique_lock alone(busy_, std::try_to_lock);
        if (!alone) throw UsageError("clear: this Renderer is at work in another thread");
        engine_.emplace();
    }

    bool reads_light_note() const override { return true; }
    WantedImage want(std::size_t /*place*/, ImageScene& /*scene*/) override {
        return {wanted_->options};
    }

    ImageWork take(std::size_t /*place*/, FinishedImage there) override {
        image_ = std::make_shared<ImageObject>(
            ImageObject{std::move(there.film),
                        std::move(there.metadata),
                        std::move(there.report),
                        engine_->renderer().scene().desc().water.bands_nm,
                        {},
                        {},
                        {},
                        engine_->renderer().scene().desc().render.view});
        RenderReport& report = image_->report;
        if (!report.light_note.empty()) report.warnings.push_back(report.light_note);
        add_matte_manifests(there.surfaces->names(), image_->film.channel_names(),
                            image_->metadata);
        if (requests_ids(wanted_->options.layers)) {
            const SurfaceNames& names = there.surfaces->names();
            add_id_names(names, image_->metadata);
            image_->objects = numbered(names.objects);
            image_->materials = numbered(names.materials);
        }
        const std::vector<std::string>& names = wanted_->derivatives;
        if (names.empty()) return {};
        const std::vector<float> all = named_derivatives(
            engine_->renderer(), names, derived(*wanted_), told(Stage::derivatives));
        const std::size_t each = all.size() / names.size();
        for (std::size_t i = 0; i < names.size(); ++i)
            image_->derivatives[names[i]].assign(&all[i * each], &all[i * each] + each);
        return {};
    }

    void warn(std::size_t /*place*/, const std::string& /*line*/) override {
        // The image's report has all warnings; Python gives them once it is there.
    }

    void tell(Stage stage, double fraction) override { task_.tell(stage, fraction); }

  private:
    static DerivativeOptions derived(const Wanted& wanted) {
        return {wanted.options.window, wanted.seed};
    }

    static std::vector<ChangedScene> changed_of(const std::vector<Change>& changes,
                                                const Wanted& wanted) {
        std::vector<ChangedScene> changed;
        changed.reserve(changes.size());
        for (const auto& [name, less, more, step] : changes)
            changed.push_back({name, image_of(*less, wanted), image_of(*more, wanted), step});
        return changed;
    }

    ProgressCallback told(Stage stage) {
        return [this, stage](double fraction) { tell(stage, fraction); };
    }

    /// What `work` makes with the renderer, which has the scene.
    template <class Work>
    std::invoke_result_t<const Work&, Renderer&> differentiate(const ImageScene& scene,
                                                               const py::object& progress,
                                                               const Work& work) {
        const std::unique_lock alone(busy_, std::try_to_lock);
        if (!alone)
            throw UsageError(
                "derivatives: this Renderer is at work, in another thread or further up; make one "
                "for each thread");
        std::invoke_result_t<const Work&, Renderer&> values;
        const auto differentiated = [&](Renderer& renderer) {
            renderer.set_scene(scene);
            values = work(renderer);
        };
        const py::gil_scoped_release release;
        task_.run([&] { with_threads(threads_, [&] { engine_->lend(*this, differentiated); }); },
                  [&](const std::vector<WatchedTask::News>& news) { watch(news, progress); });
        return values;
    }

    /// An array that owns the values.
    static py::array_t<float> owned(std::vector<float> values,
                                    const std::vector<py::ssize_t>& shape) {
        auto kept = std::make_unique<std::vector<float>>(std::move(values));
        const float* const data = kept->data();
        const py::capsule owner(kept.release(), [](void* pointer) {
            delete static_cast<std::vector<float>*>(pointer);
        });
        return py::array_t<float>(shape, data, owner);
    }

    void work(const SceneDesc& desc) {
        JobScenes scenes([&](int /*number*/) {
            SceneDesc requested = desc;
            apply_request(wanted_->image, requested);
            return requested;
        });
        engine_->run({scenes, {{0, wanted_->choice}}}, *this);
    }

    static void watch(const std::vector<WatchedTask::News>& news, const py::object& progress) {
        check_signals();
        const py::gil_scoped_acquire acquire;
        if (progress.is_none()) return;
        for (const auto& [stage, fraction] : news)
            if (progress(name_of(stage), fraction).is(py::bool_(false)))
                throw Interrupted("render: stopped by its progress callback");
    }

    int threads_;
    std::mutex busy_;
    WatchedTask task_;
    const Wanted* wanted_ = nullptr;  // of the image that is rendered
    std::shared_ptr<ImageObject> image_;
    std::optional<RunEngine> engine_;
};

}  // namespace

}  // namespace uw

UWVDB_BOUND_CLASS(uw::RendererObject);

namespace uw {

void bind_renderer(py::module_& module) {
    module.def("mean_numbers", mean_numbers, py::arg("scene"), py::arg("settings"),
               py::arg("total"));
    module.def("number_slopes", number_slopes, py::arg("scene"), py::arg("settings"),
               py::arg("total"));
    py::class_<RendererObject>(module, "Renderer")
        .def(py::init<int>(), py::arg("threads"))
        .def("render", &RendererObject::render, py::arg("scene"), py::arg("settings"),
             py::arg("progress"))
        .def("derivatives", &RendererObject::derivatives, py::arg("scene"), py::arg("changes"),
             py::arg("settings"), py::arg("progress"))
        .def("gradient", &RendererObject::gradient, py::arg("scene"), py::arg("changes"),
             py::arg("volumes"), py::arg("textures"), py::arg("weights"), py::arg("settings"),
             py::arg("progress"))
        .def("clear", &RendererObject::clear);
}

}  // namespace uw

namespace uw {

namespace {

py::dict check_of(const Check& check, const std::vector<double>& bands_nm) {
    py::dict dict;
    dict["left"] = check.left;
    dict["right"] = check.right;
    dict["component"] = check.component.name;
    dict["band"] = bands_nm[check.band];
    dict["largest"] = check.largest;
    dict["rms"] = check.rms;
    dict["tolerance"] = check.tolerance;
    dict["passed"] = check.passed();
    return dict;
}

py::list validate(const SceneObject& scene, double tolerance, std::size_t camera,
                  std::optional<int> frame) {
    SceneDesc desc = *scene.desc();
    desc.water.snow.reset();  // particles do not depend on the method
    WatchedTask task;
    ValidationOptions options;
    options.tolerance = tolerance;
    SceneValidation validation;
    run_interruptible(task, [&] {
        validation = validate_scene(scene_of_image(desc, {frame, camera}),
                                    desc.file.filename().string(), options);
    });
    py::list checks;
    for (const Check& check : validation.checks)
        checks.append(check_of(check, validation.bands_nm));
    return checks;
}

}  // namespace

void bind_validate(py::module_& module) {
    module.def("validate", validate, py::arg("scene"), py::arg("tolerance"), py::arg("camera"),
               py::arg("frame"));
}

}  // namespace uw
