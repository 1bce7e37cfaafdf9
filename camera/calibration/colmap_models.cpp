#include "camera/calibration/colmap_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "core/base/text.h"
#include "core/scene/yaml/camera_values.h"

namespace uw {
namespace {

constexpr std::array<ColmapModel, 9> k_colmap_models{{
    {"SIMPLE_PINHOLE", "f cx cy", false},
    {"PINHOLE", "fx fy cx cy", false},
    {"SIMPLE_RADIAL", "f cx cy k1", false},
    {"RADIAL", "f cx cy k1 k2", false},
    {"OPENCV", "fx fy cx cy k1 k2 p1 p2", false},
    {"FULL_OPENCV", "fx fy cx cy k1 k2 p1 p2 k3 k4 k5 k6", false},
    {"OPENCV_FISHEYE", "fx fy cx cy k1 k2 k3 k4", true},
    {"SIMPLE_RADIAL_FISHEYE", "f cx cy k1", true},
    {"RADIAL_FISHEYE", "f cx cy k1 k2", true},
}};
/// COLMAP's models of lenses that are not supported.
constexpr std::array<std::string_view, 6> k_others{"FOV",
                                                   "THIN_PRISM_FISHEYE",
                                                   "RAD_TAN_THIN_PRISM_FISHEYE",
                                                   "METASHAPE_FISHEYE",
                                                   "SIMPLE_DIVISION",
                                                   "DIVISION"};
/// A normal whose length differs from 1 by more is a mistake, not rounding.
constexpr double k_normal_tolerance = 1e-3;

std::vector<std::string> words(std::string_view text) {
    std::istringstream stream{std::string(text)};
    std::vector<std::string> result;
    for (std::string word; stream >> word;) result.push_back(word);
    return result;
}

const ColmapModel& model_called(const ConfigValue& value) {
    const std::string name = value.text("give a COLMAP camera model, such as OPENCV");
    for (const ColmapModel& model : k_colmap_models)
        if (model.name == name) return model;
    if (std::ranges::find(k_others, name) != k_others.end()) {
        value.fail(
            fmt::format("the camera model {} is not supported; calibrate with OPENCV, "
                        "FULL_OPENCV or OPENCV_FISHEYE instead",
                        name));
    }
    std::array<std::string_view, k_colmap_models.size()> names;
    std::ranges::transform(k_colmap_models, names.begin(), &ColmapModel::name);
    value.fail(
        fmt::format("unknown camera model '{}'; {}", printable(name), suggestion(name, names)));
}

/// Where the parameter of this name is stored; f is stored as fx, and the caller copies it to fy.
double* parameter_of(std::string_view name, CameraDesc& camera) {
    IntrinsicsDesc& i = camera.intrinsics;
    if (name == "f" || name == "fx") return &i.fx;
    if (name == "fy") return &i.fy;
    if (name == "cx") return &i.cx;
    if (name == "cy") return &i.cy;
    const auto index = static_cast<std::size_t>(name[1] - '1');
    return name[0] == 'k' ? &camera.distortion.k[index] : &camera.distortion.p[index];
}

}  // namespace

std::size_t colmap_parameter_count(const ConfigValue& name) {
    return words(model_called(name).parameters).size();
}

void read_colmap_model(const ConfigValue& name, std::span<const ConfigValue> parameters,
                       CameraDesc& camera) {
    const ColmapModel& model = model_called(name);
    const std::vector<std::string> names = words(model.parameters);
    if (parameters.size() != names.size()) {
        name.fail(fmt::format("{} has {} parameters ({}), found {}; check the list", model.name,
                              names.size(), model.parameters, parameters.size()));
    }
    camera.distortion = {};
    if (model.fisheye) camera.distortion.model = DistortionDesc::Model::fisheye;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string mend = fmt::format("give {} (of {})", names[i], model.parameters);
        const bool focal = names[i][0] == 'f';
        *parameter_of(names[i], camera) =
            focal ? parameters[i].positive(mend) : parameters[i].number(mend);
    }
    if (names.front() == "f") camera.intrinsics.fy = camera.intrinsics.fx;
}

void read_port_model(const ConfigValue& name, const ConfigValue& at,
                     std::span<const ConfigValue> parameters, CameraDesc& camera) {
    constexpr std::array<std::pair<std::string_view, bool>, 2> k_ports{
        {{"FLATPORT", false}, {"DOMEPORT", true}}};
    const bool is_dome = name.choice(k_ports);
    const std::string_view names = is_dome ? k_dome_parameters : k_flat_parameters;
    if (parameters.size() != k_port_parameters) {
        at.fail(fmt::format("{} has {} parameters ({}), found {}; check the list",
                            is_dome ? "DOMEPORT" : "FLATPORT", k_port_parameters, names,
                            parameters.size()));
    }
    const std::string mend = fmt::format("give {}, in metres", names);
    const Vector3 first(parameters[0].number(mend), parameters[1].number(mend),
                        parameters[2].number(mend));
    const auto set_glass = [&](auto& port) {
        port.thickness = parameters[4].non_negative(mend);
        port.n_air = read_refractive_index(parameters[5]);
        port.n_glass = read_refractive_index(parameters[6]);
        port.n_water = read_refractive_index(parameters[7]);
    };
    if (is_dome) {
        DomePortDesc port;
        port.center = at_origin_plus(first);
        port.radius = parameters[3].positive(mend);
        set_glass(port);
        check_dome(at, port);
        camera.port = port;
        return;
    }
    FlatPortDesc port;
    const double length = std::hypot(first.x, first.y, first.z);
    if (!(std::abs(length - 1) <= k_normal_tolerance)) {
        parameters[0].fail(
            fmt::format("the normal (Nx Ny Nz) has length {}; give one of length 1", length));
    }
    port.normal = first / length;
    check_port_normal(parameters[0], port.normal);
    port.distance = parameters[3].non_negative(mend);
    set_glass(port);
    camera.port = port;
}

ColmapParameters colmap_model_of(const CameraDesc& camera) {
    const DistortionDesc& d = camera.distortion;
    const auto any_above = [&](std::size_t i) {
        return std::any_of(d.k.begin() + static_cast<std::ptrdiff_t>(i), d.k.end(),
                           [](double k) { return k != 0; });
    };
    std::string_view wanted = "OPENCV";
    if (d.model == DistortionDesc::Model::fisheye)
        wanted = "OPENCV_FISHEYE";
    else if (any_above(2))
        wanted = "FULL_OPENCV";
    else if (!any_above(0) && d.p[0] == 0 && d.p[1] == 0)
        wanted = "PINHOLE";
    const ColmapModel& model = *std::ranges::find(k_colmap_models, wanted, &ColmapModel::name);
    ColmapParameters result{model.name, model.parameters, {}};
    CameraDesc copy = camera;
    for (const std::string& name : words(model.parameters))
        result.values.push_back(*parameter_of(name, copy));
    return result;
}

ColmapParameters port_model_of(const PortDesc& port) {
    if (const auto* dome = std::get_if<DomePortDesc>(&port)) {
        return {"DOMEPORT",
                k_dome_parameters,
                {dome->center.x, dome->center.y, dome->center.z, dome->radius, dome->thickness,
                 dome->n_air, dome->n_glass, dome->n_water}};
    }
    const auto& flat = std::get<FlatPortDesc>(port);
    return {"FLATPORT",
            k_flat_parameters,
            {flat.normal.x, flat.normal.y, flat.normal.z, flat.distance, flat.thickness, flat.n_air,
             flat.n_glass, flat.n_water}};
}

}  // namespace uw
