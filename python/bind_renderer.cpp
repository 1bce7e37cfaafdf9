#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "python/bindings.h"
#include "python/image_object.h"
#include "python/scene_object.h"
#include "python/signals.h"
#include "python/watched_task.h"
#include "render/id_table.h"
#include "render/image_derivative.h"
#include "render/image_header.h"
#include "render/image_request.h"

namespace py = pybind11;

namespace uw {

namespace {

constexpr std::size_t k_longest_value = 80;  // in messages

/// What of a scene is rendered, and how.
struct Wanted {
    ImageRequest image;
    ImageChoice choice;
    RenderOptions options;
    std::vector<std::string> derivatives;
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
    if (wanted.image.samples && *wanted.image.samples < 1)
        refuse_setting(settings, "samples", "a whole number of 1 or more");
    if (wanted.image.size && std::ranges::min(*wanted.image.size) < 1)
        refuse_setting(settings, "size", "(width, height) of 1 pixel or more");
    if (wanted.options.paths.orders < 0) refuse_setting(settings, "orders", number);
    wanted.options.paths.error = wanted.image.error;
    wanted.options.frame = wanted.choice.frame.value_or(0);
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

class RendererObject {
  public:
    explicit RendererObject(int threads)
        : threads_(threads), renderer_([this](const std::string& stage, double fraction) {
              return task_.tell(stage, fraction);
          }) {}

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
        std::shared_ptr<ImageObject> image;
        const py::gil_scoped_release release;
        task_.run([&] { with_threads(threads_, [&] { image = work(*desc, wanted); }); },
                  [&](const std::vector<WatchedTask::News>& news) { watch(news, progress); });
        return image;
    }

    void clear() {
        const std::unique_lock alone(busy_, std::try_to_lock);
        if (!alone) throw UsageError("clear: this Renderer is at work in another thread");
        renderer_ = Renderer([this](const std::string& stage, double fraction) {
            return task_.tell(stage, fraction);
        });
    }

  private:
    std::shared_ptr<ImageObject> work(const SceneDesc& desc, const Wanted& wanted) {
        SceneDesc requested = desc;
        apply_request(wanted.image, requested);
        renderer_.set_scene(scene_of_image(requested, wanted.choice));
        renderer_.render(wanted.options);
        const AssembledScene& scene = renderer_.assembled();
        ImageObject image{
            renderer_.release_film(),
            metadata_of(scene, wanted.choice.frame, wanted.options.paths, renderer_.report()),
            renderer_.report(),
            scene.desc.water.bands_nm,
            {},
            {}};
        if (requests_ids(wanted.options.layers)) {
            const SurfaceNames& names = scene.surfaces->names();
            add_id_names(names, image.metadata);
            image.objects = numbered(names.objects);
            image.materials = numbered(names.materials);
        }
        for (const std::string& name : wanted.derivatives)
            image.derivatives[name] = image_derivative(renderer_, name, wanted.options);
        return std::make_shared<ImageObject>(std::move(image));
    }

    static void watch(const std::vector<WatchedTask::News>& news, const py::object& progress) {
        check_signals();
        const py::gil_scoped_acquire acquire;
        if (progress.is_none()) return;
        for (const auto& [stage, fraction] : news)
            if (progress(stage, fraction).is(py::bool_(false)))
                throw Interrupted("render: stopped by its progress callback");
    }

    int threads_;
    std::mutex busy_;
    WatchedTask task_;
    Renderer renderer_;
};

}  // namespace

void bind_renderer(py::module_& module) {
    py::class_<RendererObject>(module, "Renderer")
        .def(py::init<int>(), py::arg("threads"))
        .def("render", &RendererObject::render, py::arg("scene"), py::arg("settings"),
             py::arg("progress"))
        .def("clear", &RendererObject::clear);
}

}  // namespace uw
