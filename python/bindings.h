#pragma once

#include <pybind11/pybind11.h>

namespace uw {

/// The parts of the compiled module.

void bind_errors(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_image(pybind11::module_& module);
void bind_renderer(pybind11::module_& module);
void bind_camera(pybind11::module_& module);
void bind_water(pybind11::module_& module);
void bind_files(pybind11::module_& module);
void bind_validate(pybind11::module_& module);

}  // namespace uw
