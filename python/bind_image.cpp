#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/preview.h"
#include "python/bindings.h"
#include "python/image_object.h"
#include "python/signals.h"

namespace py = pybind11;

namespace uw {

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
py::array_t<float> derivative(const py::object& self, const std::string& name) {
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
    dict["exposure_parts"] = r.exposure_parts;
    dict["motion_pixels"] = r.motion_pixels;
    dict["snow_particles"] = r.snow_particles;
    return dict;
}

void save_image(const ImageObject& image, const std::filesystem::path& file,
                std::optional<double> exposure, const std::string& precision) {
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
        .def("save", save_image, py::arg("file"), py::arg("exposure"), py::arg("precision"));
}

}  // namespace uw
