#include "camera/colmap_calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "camera/calibration.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/camera_desc.h"

namespace uw {

namespace {

/// COLMAP's camera models and those of its refractive fork, which Calibmar shares: a name and a
/// list of numbers.
struct ColmapModel {
    std::string_view name;
    std::string_view parameters;  // their names in order: "f cx cy k1"
    bool fisheye;
};

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
/// The number of parameters of either port, and their names.
constexpr std::size_t k_port_parameters = 8;
constexpr std::string_view k_flat_parameters = "Nx Ny Nz int_dist int_thick na ng nw";
constexpr std::string_view k_dome_parameters = "Cx Cy Cz int_radius int_thick na ng nw";
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

/// Number of parameters of the model called `name`. Throws InputError at `name` for an unsupported
/// one.
std::size_t colmap_parameter_count(const ConfigValue& name) {
    return words(model_called(name).parameters).size();
}

/// Sets intrinsics and distortion from the parameters of the model called `name`.
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
        const std::string hint = fmt::format("give {} (of {})", names[i], model.parameters);
        const bool focal = names[i][0] == 'f';
        *parameter_of(names[i], camera) =
            focal ? parameters[i].positive(hint) : parameters[i].number(hint);
    }
    if (names.front() == "f") camera.intrinsics.fy = camera.intrinsics.fx;
}

/// Sets the port from `name`, FLATPORT or DOMEPORT, and its parameters; a wrong number of them is
/// reported at `at`.
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
    const std::string hint = fmt::format("give {}, in metres", names);
    const Vector3 first(parameters[0].number(hint), parameters[1].number(hint),
                        parameters[2].number(hint));
    const auto set_glass = [&](auto& port) {
        port.thickness = parameters[4].non_negative(hint);
        port.n_air = read_refractive_index(parameters[5]);
        port.n_glass = read_refractive_index(parameters[6]);
        port.n_water = read_refractive_index(parameters[7]);
    };
    if (is_dome) {
        DomePortDesc port;
        port.center = at_origin_plus(first);
        port.radius = parameters[3].positive(hint);
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
    port.distance = parameters[3].non_negative(hint);
    set_glass(port);
    camera.port = port;
}

}  // namespace

ColmapParameters colmap_model_of(const CameraDesc& camera) {
    const DistortionDesc& d = camera.distortion;
    std::string_view wanted = "OPENCV";
    if (d.model == DistortionDesc::Model::fisheye)
        wanted = "OPENCV_FISHEYE";
    else if (has_radial_above(d, 2))
        wanted = "FULL_OPENCV";
    else if (!is_distorted(d))
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

// COLMAP's cameras.txt: one camera per line,
//   CAMERA_ID MODEL WIDTH HEIGHT PARAMS...
// and in the refractive fork (She et al. 2024) PARAMS is followed by FLATPORT or DOMEPORT and its
// eight numbers. '#' starts a comment line.

namespace {

constexpr std::size_t k_max_tokens = 64;

/// The tokens of one line as values with their positions in the file.
struct Line {
    int number = 0;
    std::vector<ConfigNode> tokens;

    ConfigValue value(std::size_t i, std::string name) const {
        return {tokens[i], std::move(name)};
    }
};

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

Line split(std::string_view text, int number, const std::shared_ptr<const std::string>& origin) {
    Line line{number, {}};
    for (std::size_t i = 0; i < text.size();) {
        if (is_blank(text[i])) {
            ++i;
            continue;
        }
        const std::size_t begin = i;
        while (i < text.size() && !is_blank(text[i])) ++i;
        ConfigNode node;
        node.kind = ConfigNode::Kind::scalar;
        node.scalar = text.substr(begin, i - begin);
        node.position = {origin, number, static_cast<int>(begin) + 1};
        line.tokens.push_back(std::move(node));
        if (line.tokens.size() > k_max_tokens) break;  // no camera has this many
    }
    return line;
}

/// Visits all lines that are neither empty nor comments.
template <class Visit>
void for_each_line(std::string_view text, Visit visit) {
    int number = 0;
    while (!text.empty()) {
        const std::string_view line = take_line(text);
        ++number;
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string_view::npos || line[first] == '#') continue;
        if (!visit(line, number)) return;
    }
}

bool is_number(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_model(std::string_view text) {
    return !text.empty() &&
           text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_") == std::string_view::npos;
}

Calibration read_line(const Line& line) {
    constexpr auto k_hint = "write ID MODEL WIDTH HEIGHT PARAMS...";
    if (line.tokens.size() < 5 || line.tokens.size() > k_max_tokens)
        line.value(0, "").fail(fmt::format("is not a COLMAP camera; {}", k_hint));
    Calibration result;
    result.format = CalibrationFormat::colmap;
    result.camera = line.tokens[0].scalar;
    const ConfigValue model = line.value(1, "MODEL");
    read_resolution(line.value(2, ""), line.value(2, "WIDTH"), line.value(3, "HEIGHT"),
                    result.desc);
    const std::size_t count = colmap_parameter_count(model);
    std::vector<ConfigValue> parameters, port;
    std::size_t i = 4;
    for (; i < line.tokens.size() && !is_model(line.tokens[i].scalar); ++i)
        parameters.push_back(line.value(i, fmt::format("PARAMS[{}]", i - 4)));
    read_colmap_model(model, parameters, result.desc);
    result.model = model.node().scalar;
    if (i < line.tokens.size()) {
        const ConfigValue name = line.value(4 + count, "port");
        for (++i; i < line.tokens.size(); ++i)
            port.push_back(line.value(i, fmt::format("port[{}]", port.size())));
        read_port_model(name, name, port, result.desc);
        result.model += ", " + name.node().scalar;
    }
    return result;
}

}  // namespace

std::string colmap_camera_line(std::size_t id, const CameraDesc& camera, bool with_port) {
    const ColmapParameters model = colmap_model_of(camera);
    std::string line = fmt::format("{} {} {} {} {}", id, model.name, camera.width, camera.height,
                                   fmt::join(model.values, " "));
    if (with_port && camera.port) {
        const ColmapParameters port = port_model_of(*camera.port);
        line += fmt::format(" {} {}", port.name, fmt::join(port.values, " "));
    }
    return line + "\n";
}

bool looks_like_colmap(std::string_view text) {
    bool result = false;
    for_each_line(text, [&](std::string_view line, int number) {
        const Line first = split(line, number, nullptr);
        result = first.tokens.size() >= 4 && is_number(first.tokens[0].scalar) &&
                 is_model(first.tokens[1].scalar);
        return false;
    });
    return result;
}

Calibration read_colmap(std::string_view text, const std::string& origin,
                        const std::string& camera) {
    const auto shared = std::make_shared<const std::string>(origin);
    std::vector<std::string> names;
    std::vector<std::pair<std::string_view, int>> lines;
    for_each_line(text, [&](std::string_view line, int number) {
        const std::size_t first = line.find_first_not_of(" \t");
        const std::size_t end = std::min(line.find_first_of(" \t\r", first), line.size());
        names.emplace_back(line.substr(first, end - first));
        lines.emplace_back(line, number);
        return true;
    });
    const std::string chosen = choose_camera(names, camera, origin);
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] != chosen) continue;
        Calibration result = read_line(split(lines[i].first, lines[i].second, shared));
        result.cameras = names;
        return result;
    }
    throw InputError(origin + ": contains no camera; give another file");
}

std::string write_colmap(const CameraDesc& camera) {
    std::string text =
        "# Camera list with one line of data per camera:\n"
        "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[] OPTIONAL[REFRAC_MODEL REFRAC_PARAMS[]]\n"
        "# Number of cameras: 1\n";
    text += colmap_camera_line(1, camera, true);
    if (camera.port)
        text += "# Stock COLMAP does not support ports. The camera alone, as it is in air:\n# " +
                colmap_camera_line(1, camera, false);
    return text;
}

// Calibmar's calibration.yaml: COLMAP's models by name and list of parameters, image corner at (0,
// 0) (Calibmar adds the half pixel to what OpenCV detects), lengths in metres.

bool looks_like_calibmar(const ConfigNode& root) {
    return root.find("non_svp_model") != nullptr ||
           (root.find("model") != nullptr && root.find("parameters") != nullptr);
}

Calibration read_calibmar(const ConfigValue& root) {
    constexpr auto k_hint = "give model, parameters, width and height as Calibmar writes them";
    Calibration result;
    result.format = CalibrationFormat::calibmar;
    const ConfigValue model = require_value(root, "model", k_hint);
    const ConfigValue parameters = require_value(root, "parameters", k_hint);
    read_colmap_model(model, parameters.list(k_hint), result.desc);
    const ConfigValue width = require_value(root, "width", k_hint);
    read_resolution(width, width, require_value(root, "height", k_hint), result.desc);
    result.model = model.node().scalar;
    const ConfigNode* const port = root.node().find("non_svp_model");
    if (port == nullptr || port->scalar == "NONE") return result;
    const ConfigValue name(*port, "non_svp_model");
    const ConfigValue numbers =
        require_value(root, "non_svp_parameters", "give the eight numbers of the port");
    read_port_model(name, numbers, numbers.list("give the eight numbers of the port"), result.desc);
    result.model += ", " + name.node().scalar;
    return result;
}

std::string write_calibmar(const CameraDesc& camera) {
    const ColmapParameters model = colmap_model_of(camera);
    std::string text = fmt::format("model: {}\n# {}\nparameters: {}\n", model.name, model.names,
                                   number_list(model.values));
    if (camera.port) {
        const ColmapParameters port = port_model_of(*camera.port);
        text += fmt::format("non_svp_model: {}\n# {}\nnon_svp_parameters: {}\n", port.name,
                            port.names, number_list(port.values));
    } else {
        text += "non_svp_model: NONE\nnon_svp_parameters: []\n";
    }
    return text + fmt::format("width: {}\nheight: {}\n", camera.width, camera.height);
}

}  // namespace uw
