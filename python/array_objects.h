#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <string>

#include "core/base/affine.h"
#include "core/meshes/mesh.h"
#include "media/vdb/loaded_grid.h"

namespace uw {

/// Arrays of any strides are taken as they are; others are converted.
using FloatArray = pybind11::array_t<float, pybind11::array::forcecast>;
/// Rows of numbers, contiguous.
using DoubleRows = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// An affine map as a matrix of 4 x 4 numbers, and back.
pybind11::array_t<double> matrix_of(const Affine& map);
Affine affine_of(const DoubleRows& matrix);

/// Grids and meshes in memory as tuples for pickling, and back, to the bit.
pybind11::object state_of(const LoadedGrid& grid);
std::shared_ptr<const LoadedGrid> grid_of_state(const pybind11::tuple& state);
pybind11::object state_of(const TriangleMesh& mesh);
std::shared_ptr<const TriangleMesh> mesh_of_state(const pybind11::tuple& state);

}  // namespace uw
