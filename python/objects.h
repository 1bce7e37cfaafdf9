#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "core/base/vector_math.h"
#include "core/geometry/mesh.h"
#include "core/image/pixel_image.h"
#include "core/scene/yaml_document.h"
#include "media/volumes/loaded_grid.h"

namespace uw {

/// Arrays of any strides are taken as they are; others are converted.
using FloatArray = pybind11::array_t<float, pybind11::array::forcecast>;
/// Rows of numbers, contiguous.
using DoubleRows = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// An affine map as a matrix of 4 x 4 numbers, and back.
pybind11::array_t<double> matrix_of(const Affine& map);
Affine affine_of(const DoubleRows& matrix);

/// Diffuse, by a texture of linear light that ends at its edges.
MeshMaterial textured_material(const PixelImage& image);

/// Grids and meshes in memory as tuples for pickling, and back, to the bit.
pybind11::object state_of(const LoadedGrid& grid);
std::shared_ptr<const LoadedGrid> grid_of_state(const pybind11::tuple& state);
pybind11::object state_of(const TriangleMesh& mesh);
std::shared_ptr<const TriangleMesh> mesh_of_state(const pybind11::tuple& state);

/// Python's objects as the value of a scene's key: dict, list, tuple and range, str and paths,
/// numbers, bool, None, and what has tolist(), as NumPy's arrays and numbers. Positions are left
/// empty. Throws TypeError for others, and InputError, which begins with `where` and the path of
/// the value from `path` on, for what is beyond a scene file's YamlLimits, as a list that contains
/// itself.
ConfigNode node_of(pybind11::handle object, const std::string& where, const std::string& path = "");

/// A key's value as Python's objects: text that is no number is str, true and false are bool.
pybind11::object object_of(const ConfigNode& node);

/// A tree with all that it is made of, positions included, as tuples; and back.
pybind11::object state_of(const ConfigNode& node);
ConfigNode node_of_state(const pybind11::tuple& state);

}  // namespace uw
