#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/camera_desc.h"
#include "core/scene/config_value.h"

namespace uw {

/// COLMAP's camera models and those of its refractive fork, which Calibmar shares: a name and a
/// list of numbers. The image corner is (0, 0), as in uwvdb.
struct ColmapModel {
    std::string_view name;
    std::string_view parameters;  // their names in order: "f cx cy k1"
    bool fisheye;
};

/// Number of parameters of the model called `name`. Throws InputError at `name` for an unsupported
/// one.
std::size_t colmap_parameter_count(const ConfigValue& name);
/// Sets intrinsics and distortion from the parameters of the model called `name`.
void read_colmap_model(const ConfigValue& name, std::span<const ConfigValue> parameters,
                       CameraDesc& camera);

/// Number of parameters of either port.
inline constexpr std::size_t k_port_parameters = 8;
inline constexpr std::string_view k_flat_parameters = "Nx Ny Nz int_dist int_thick na ng nw";
inline constexpr std::string_view k_dome_parameters = "Cx Cy Cz int_radius int_thick na ng nw";
/// Sets the port from `name`, FLATPORT or DOMEPORT, and its parameters; a wrong number of them is
/// reported at `at`.
void read_port_model(const ConfigValue& name, const ConfigValue& at,
                     std::span<const ConfigValue> parameters, CameraDesc& camera);

/// A model and its parameters, ready to be written.
struct ColmapParameters {
    std::string_view name;
    std::string_view names;  // of the parameters
    std::vector<double> values;
};
/// The simplest model that covers all of the camera's distortion.
ColmapParameters colmap_model_of(const CameraDesc& camera);
ColmapParameters port_model_of(const PortDesc& port);

}  // namespace uw
