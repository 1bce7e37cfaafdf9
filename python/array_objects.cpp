#include "python/array_objects.h"

#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <string_view>
#include <vector>

namespace py = pybind11;

namespace uw {

namespace {

constexpr std::size_t k_nano_alignment = 32;  // of NanoVDB's grids in memory

template <class T>
py::bytes bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
std::vector<T> values_of(const py::handle& object) {
    const auto bytes = object.cast<std::string_view>();
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

py::tuple state_of(const NanoGrid& brick) {
    const Bounds& support = brick.support();
    py::list box;
    for (const Point3& corner : {support.min, support.max})
        for (int axis = 0; axis < 3; ++axis) box.append(corner[axis]);
    return py::make_tuple(py::bytes(static_cast<const char*>(brick.data()), brick.bytes()), box);
}

NanoGrid brick_of_state(const py::tuple& state) {
    const auto bytes = state[0].cast<std::string_view>();
    const auto box = state[1].cast<std::array<double, 6>>();
    void* const memory = ::operator new (bytes.size(), std::align_val_t{k_nano_alignment});
    std::memcpy(memory, bytes.data(), bytes.size());
    std::shared_ptr<const void> storage(
        memory, [](void* owned) { ::operator delete (owned, std::align_val_t{k_nano_alignment}); });
    // The support reaches one beyond the values, which NanoGrid adds.
    std::array<int, 3> min{}, max{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        min[axis] = static_cast<int>(std::lround(box[axis])) + 1;
        max[axis] = static_cast<int>(std::lround(box[axis + 3])) - 1;
    }
    return {std::move(storage), memory, bytes.size(), min, max};
}

}  // namespace

py::array_t<double> matrix_of(const Affine& map) {
    py::array_t<double> matrix({4, 4});
    auto cell = matrix.mutable_unchecked<2>();
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 3; ++column)
            cell(row, column) = row < 3 ? map.linear()[column][row] : 0;
        cell(row, 3) = row < 3 ? map.offset()[row] : 1;
    }
    return matrix;
}

Affine affine_of(const DoubleRows& matrix) {
    const auto cell = matrix.unchecked<2>();
    Matrix3 linear(1.0);
    Vector3 offset(0.0);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) linear[column][row] = cell(row, column);
        offset[row] = cell(row, 3);
    }
    return {linear, offset};
}

py::object state_of(const LoadedGrid& grid) {
    py::list bricks;
    for (const NanoGrid& brick : grid.bricks) bricks.append(state_of(brick));
    const GridStatistics& s = grid.statistics;
    return py::make_tuple(
        grid.name, matrix_of(grid.file_from_index), bricks,
        py::make_tuple(s.active_voxels, s.nan_voxels, s.infinite_voxels, s.negative_voxels),
        py::make_tuple(s.background, s.min, s.mean, s.max), grid.warnings);
}

std::shared_ptr<const LoadedGrid> grid_of_state(const py::tuple& state) {
    auto grid = std::make_shared<LoadedGrid>();
    grid->name = state[0].cast<std::string>();
    grid->file_from_index = affine_of(state[1].cast<DoubleRows>());
    for (const py::handle brick : state[2])
        grid->bricks.push_back(brick_of_state(brick.cast<py::tuple>()));
    const auto counts = state[3].cast<std::array<std::int64_t, 4>>();
    const auto values = state[4].cast<std::array<double, 4>>();
    grid->statistics = {counts[0], counts[1], counts[2], counts[3],
                        values[0], values[1], values[2], values[3]};
    grid->warnings = state[5].cast<std::vector<std::string>>();
    return grid;
}

py::object state_of(const TriangleMesh& mesh) {
    return py::make_tuple(bytes_of(mesh.positions), bytes_of(mesh.triangles));
}

std::shared_ptr<const TriangleMesh> mesh_of_state(const py::tuple& state) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions = values_of<float>(state[0]);
    mesh->triangles = values_of<std::uint32_t>(state[1]);
    return mesh;
}

}  // namespace uw
