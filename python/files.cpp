#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "camera/calibration.h"
#include "core/base/version.h"
#include "core/scene/yaml_document.h"
#include "media/inspection/vdb_inspect.h"
#include "media/volumes/array_grid.h"
#include "media/volumes/loaded_grid.h"
#include "media/volumes/vdb_header.h"
#include "media/volumes/vdb_writer.h"
#include "python/arguments.h"
#include "python/bindings.h"
#include "python/camera.h"
#include "python/objects.h"

namespace py = pybind11;

namespace uw {

namespace {

/// What a file's fault is reported at, beside its name.
constexpr const char* k_where = "read_vdb";

py::tuple read_vdb(const FileName& file, const Text& wanted) {
    const std::string& name = wanted;
    GridArray array;
    VdbHeader header;
    {
        const py::gil_scoped_release release;
        header = read_vdb_header(file, k_where);
        array = read_grid_array(
            header, name.empty() && header.grids.size() == 1 ? header.grids[0].name : name,
            k_where);
    }
    const auto owned = new std::vector<float>(std::move(array.values));
    const py::capsule owner(owned,
                            [](void* values) { delete static_cast<std::vector<float>*>(values); });
    const std::vector<py::ssize_t> shape(array.size.begin(), array.size.end());
    const py::array_t<float> values(shape, owned->data(), owner);
    // Where a scene places it that does not say how.
    const Placement placement = decide_placement(header, {});
    const double shift = placement.centering == Centering::cell ? 0.5 : 0.0;
    const Vector3 first = Vector3(array.first[0], array.first[1], array.first[2]) + shift;
    const Affine world_from_index =
        upright_from_file(placement.up) * array.file_from_index * Affine::translation(first);
    return py::make_tuple(array.name, values, matrix_of(world_from_index));
}

using Values = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// Arrays of three axes by the names of their grids; all have one place.
void write_vdb_arrays(const FileName& file,
                      const std::vector<std::pair<std::string, Values>>& arrays, double voxel_size,
                      const std::array<double, 3>& origin) {
    std::vector<VdbOutputGrid> grids;
    for (const auto& [name, values] : arrays) {
        VdbOutputGrid& grid = grids.emplace_back();
        grid.name = name;
        for (std::size_t axis = 0; axis < grid.size.size(); ++axis)
            grid.size[axis] = static_cast<int>(values.shape(static_cast<py::ssize_t>(axis)));
        grid.voxel_size = voxel_size;
        grid.origin = {origin[0], origin[1], origin[2]};
        const auto rows = static_cast<std::size_t>(grid.size[1]);
        const auto columns = static_cast<std::size_t>(grid.size[2]);
        grid.value = [first = values.data(), rows, columns](int i, int j, int k) {
            return first[(static_cast<std::size_t>(i) * rows + static_cast<std::size_t>(j)) *
                             columns +
                         static_cast<std::size_t>(k)];
        };
    }
    const py::gil_scoped_release release;
    write_vdb(file, grids, {{"creator", "uwvdb " + program_version()}});
}

py::object box_of(const Bounds& bounds) {
    if (bounds.empty()) return py::none();
    const auto corner = [](const Point3& p) { return py::make_tuple(p.x, p.y, p.z); };
    return py::make_tuple(corner(bounds.min), corner(bounds.max));
}

py::dict grid_of(const GridInspection& grid) {
    py::dict dict;
    dict["name"] = grid.summary.name;
    dict["type"] = grid.summary.value_type;
    dict["class"] = grid.summary.grid_class;
    dict["unusable"] = grid.unusable;
    dict["unread"] = grid.unread;
    dict["transform"] = grid.transform;
    dict["voxel_size"] = py::make_tuple(grid.voxel_size.x, grid.voxel_size.y, grid.voxel_size.z);
    dict["bounds"] = box_of(grid.world_bounds);
    dict["active_voxels"] = grid.active_voxels;
    for (const char* key : {"min", "mean", "max"}) dict[key] = py::none();
    if (!grid.values) return dict;
    dict["min"] = grid.values->min;
    dict["mean"] = grid.values->mean;
    dict["max"] = grid.values->max;
    return dict;
}

py::dict inspect(const FileName& file) {
    VdbInspection inspection;
    {
        const py::gil_scoped_release release;
        inspection = inspect_vdb(file, "inspect");
    }
    py::list grids;
    for (const GridInspection& grid : inspection.grids) grids.append(grid_of(grid));
    py::dict dict;
    dict["creator"] = inspection.header.creator;
    dict["centering"] = inspection.placement.centering == Centering::cell ? "cell" : "node";
    dict["up"] = name_of_up(inspection.placement.up);
    dict["grids"] = grids;
    return dict;
}

/// The camera of a file, as the section of a scene that describes it and by itself.
py::dict load_calibration(const FileName& file, const Text& camera) {
    const Calibration calibration = read_calibration(file, camera);
    const std::string text = write_calibration(CalibrationFormat::scene, calibration.desc);
    py::dict dict;
    dict["format"] = std::string(word_of(calibration.format));
    dict["name"] = calibration.camera;
    dict["names"] = calibration.cameras;
    dict["model"] = calibration.model;
    dict["warnings"] = calibration.warnings;
    dict["section"] = object_of(parse_yaml(text, "calibration"))["camera"];
    dict["camera"] = camera_of(calibration.desc);
    return dict;
}

}  // namespace

void bind_files(py::module_& module) {
    module.def("read_vdb", read_vdb, py::arg("file"), py::arg("grid"));
    module.def("write_vdb", write_vdb_arrays, py::arg("file"), py::arg("arrays"),
               py::arg("voxel_size"), py::arg("origin"));
    module.def("inspect", inspect, py::arg("file"));
    module.def("load_calibration", load_calibration, py::arg("file"), py::arg("camera"));
}

}  // namespace uw
