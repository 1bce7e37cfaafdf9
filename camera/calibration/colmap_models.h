#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/camera_desc.h"
#include "core/scene/yaml/config_value.h"

namespace uw {

/// COLMAP's camera models and those of its refractive fork, which Calibmar shares: a name and a
/// list of numbers. The image's corner is (0, 0), as ours.
struct ColmapModel {
    std::string_view name;
    std::string_view parameters;  // their names in order: "f cx cy k1"
    bool fisheye;
};

/// Number of parameters of the model called `name`. Throws InputError at `name` for one that we
/// have not.
std::size_t colmap_parameter_count(const ConfigValue& name);
/// Sets intrinsics and distortion from the parameters of the model called `name`.
void read_colmap_model(const ConfigValue& name, std::span<const ConfigValue> parameters,
                       CameraDesc& camera);

/// Parameters of either port: 8.
inline constexpr std::size_t k_port_parameters = 8;
inline constexpr std::string_view k_flat_parameters = "Nx Ny Nz int_dist int_thick na ng nw";
inline constexpr std::string_view k_dome_parameters = "Cx Cy Cz int_radius int_thick na ng nw";
/// Sets the port from `name`, FLATPORT or DOMEPORT, and its parameters, of which `at` is the whole.
void read_port_model(const ConfigValue& name, const ConfigValue& at,
                     std::span<const ConfigValue> parameters, CameraDesc& camera);

/// A model with its parameters, to be written.
struct ColmapParameters {
    std::string_view name;
    std::string_view names;  // of the parameters
    std::vector<double> values;
};
/// The plainest model that has all of the camera's distortion.
ColmapParameters colmap_model_of(const CameraDesc& camera);
ColmapParameters port_model_of(const PortDesc& port);

}  // namespace uw
