#include "python/camera.h"

#include <pybind11/stl.h>

#include <array>
#include <limits>
#include <optional>
#include <variant>

#include "core/base/parallel.h"
#include "python/bindings.h"
#include "python/objects.h"
#include "python/scene.h"
#include "render/exposure.h"
#include "render/image_scene.h"
#include "render/view_matcher.h"

namespace py = pybind11;

namespace uw {

namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t k_rows_per_part = 1024;

/// Calls `body(row)` for all rows, without the interpreter's lock.
void for_rows(py::ssize_t count, const std::function<void(py::ssize_t row)>& body) {
    const py::gil_scoped_release release;
    const auto rows = static_cast<std::size_t>(count);
    parallel_for((rows + k_rows_per_part - 1) / k_rows_per_part, [&](std::size_t part) {
        const std::size_t end = std::min(rows, (part + 1) * k_rows_per_part);
        for (std::size_t row = part * k_rows_per_part; row < end; ++row)
            body(static_cast<py::ssize_t>(row));
    });
}

CameraObject camera_of_scene(const SceneObject& scene, std::size_t camera, std::optional<int> frame,
                             std::optional<double> wavelength) {
    SceneDesc desc = *scene.desc();
    desc.volumes.clear();
    const ImageScene image =
        ImageScene(std::move(desc), {frame, camera}).with([&](SceneDesc& seen) {
            if (wavelength) set_wavelength(seen.camera, *wavelength);
        });
    return {image.desc().camera, camera_of_truth(image)};
}

py::tuple rays(const CameraObject& self, const DoubleRows& pixels) {
    py::array_t<double> origins({pixels.shape(0), py::ssize_t{3}});
    py::array_t<double> directions({pixels.shape(0), py::ssize_t{3}});
    const auto pixel = pixels.unchecked<2>();
    auto origin = origins.mutable_unchecked<2>();
    auto direction = directions.mutable_unchecked<2>();
    for_rows(pixels.shape(0), [&](py::ssize_t row) {
        std::optional<Ray> ray;
        if (is_in_image({pixel(row, 0), pixel(row, 1)}, self.camera))
            ray = self.camera.refracted_ray(pixel(row, 0), pixel(row, 1));
        for (int axis = 0; axis < 3; ++axis) {
            origin(row, axis) = ray ? ray->origin[axis] : k_nan;
            direction(row, axis) = ray ? ray->direction[axis] : k_nan;
        }
    });
    return py::make_tuple(origins, directions);
}

py::array_t<double> project(const CameraObject& self, const DoubleRows& points, bool beyond) {
    py::array_t<double> pixels({points.shape(0), py::ssize_t{2}});
    const auto point = points.unchecked<2>();
    auto pixel = pixels.mutable_unchecked<2>();
    for_rows(points.shape(0), [&](py::ssize_t row) {
        const Point3 at{point(row, 0), point(row, 1), point(row, 2)};
        std::optional<ImagePoint> found;
        if (std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z))
            found = self.camera.project(at);
        if (found && !beyond && !is_in_image(*found, self.camera)) found.reset();
        pixel(row, 0) = found ? found->x : k_nan;
        pixel(row, 1) = found ? found->y : k_nan;
    });
    return pixels;
}

py::array_t<double> matrix(const CameraObject& self) {
    const IntrinsicsDesc& k = self.desc.intrinsics;
    py::array_t<double> matrix({3, 3});
    auto cell = matrix.mutable_unchecked<2>();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) cell(row, column) = row == column ? 1 : 0;
    cell(0, 0) = k.fx;
    cell(1, 1) = k.fy;
    cell(0, 2) = k.cx;
    cell(1, 2) = k.cy;
    return matrix;
}

py::tuple distortion(const CameraObject& self) {
    const DistortionDesc& d = self.desc.distortion;
    if (d.model == DistortionDesc::Model::fisheye)
        return py::make_tuple("fisheye", std::vector<double>{d.k[0], d.k[1], d.k[2], d.k[3]});
    return py::make_tuple("brown-conrady", std::vector<double>{d.k[0], d.k[1], d.p[0], d.p[1],
                                                               d.k[2], d.k[3], d.k[4], d.k[5]});
}

/// A port of one kind: `place` and `length` are what it has beside its glass.
template <class PortKind>
py::tuple glass_state(const char* kind, const std::array<double, 3>& place, double length,
                      const PortKind& port) {
    return py::make_tuple(
        kind, place, std::array{length, port.thickness, port.n_air, port.n_glass, port.n_water},
        port.fresnel, port.radiance_in_air);
}

py::object port_state(const std::optional<PortDesc>& port) {
    if (!port) return py::none();
    if (const auto* flat = std::get_if<FlatPortDesc>(&*port)) {
        const Vector3& n = flat->normal;
        return glass_state("flat", {n.x, n.y, n.z}, flat->distance, *flat);
    }
    const auto& dome = std::get<DomePortDesc>(*port);
    return glass_state("dome", {dome.center.x, dome.center.y, dome.center.z}, dome.radius, dome);
}

std::optional<PortDesc> port_of_state(const py::object& state) {
    if (state.is_none()) return std::nullopt;
    const auto saved = state.cast<py::tuple>();
    const auto [x, y, z] = saved[1].cast<std::array<double, 3>>();
    const auto [length, thickness, n_air, n_glass, n_water] =
        saved[2].cast<std::array<double, 5>>();
    const auto fresnel = saved[3].cast<bool>(), in_air = saved[4].cast<bool>();
    if (saved[0].cast<std::string>() == "flat")
        return FlatPortDesc{{x, y, z}, length, thickness, n_air, n_glass, n_water, fresnel, in_air};
    return DomePortDesc{{x, y, z}, length, thickness, n_air, n_glass, n_water, fresnel, in_air};
}

/// What rays depend on, to the bit.
py::tuple camera_state(const CameraObject& self) {
    if (self.camera.is_rolling())
        throw py::type_error(
            "a camera that moves behind a rolling shutter cannot be pickled; pickle its scene, "
            "and take the camera of that");
    const CameraDesc& desc = self.desc;
    const IntrinsicsDesc& k = desc.intrinsics;
    const bool is_fisheye = desc.distortion.model == DistortionDesc::Model::fisheye;
    return py::make_tuple(desc.width, desc.height, std::array{k.fx, k.fy, k.cx, k.cy}, is_fisheye,
                          desc.distortion.k, desc.distortion.p, port_state(desc.port),
                          matrix_of(desc.world_from_camera), desc.wavelength_nm);
}

CameraObject camera_of_state(const py::tuple& state) {
    CameraDesc desc;
    desc.width = state[0].cast<int>();
    desc.height = state[1].cast<int>();
    const auto k = state[2].cast<std::array<double, 4>>();
    desc.intrinsics = {k[0], k[1], k[2], k[3]};
    if (state[3].cast<bool>()) desc.distortion.model = DistortionDesc::Model::fisheye;
    desc.distortion.k = state[4].cast<std::array<double, 6>>();
    desc.distortion.p = state[5].cast<std::array<double, 2>>();
    desc.port = port_of_state(state[6]);
    desc.world_from_camera = affine_of(state[7].cast<DoubleRows>());
    desc.wavelength_nm = state[8].cast<double>();
    return camera_of(desc);
}

}  // namespace

void bind_camera(py::module_& module) {
    py::class_<CameraObject>(module, "Camera")
        .def(py::init(&camera_of_scene), py::arg("scene"), py::arg("camera"), py::arg("frame"),
             py::arg("wavelength"))
        .def("rays", rays, py::arg("pixels"))
        .def("project", project, py::arg("points"), py::arg("beyond"))
        .def_property_readonly("width", [](const CameraObject& c) { return c.camera.width(); })
        .def_property_readonly("height", [](const CameraObject& c) { return c.camera.height(); })
        .def_property_readonly("wavelength",
                               [](const CameraObject& c) { return c.desc.wavelength_nm; })
        .def_property_readonly("matrix", matrix)
        .def_property_readonly("distortion", distortion)
        .def_property_readonly(
            "world_from_camera",
            [](const CameraObject& c) { return matrix_of(c.camera.world_from_camera()); })
        .def(py::pickle([](const CameraObject& camera) { return camera_state(camera); },
                        [](const py::tuple& saved) { return camera_of_state(saved); }));
}

}  // namespace uw
