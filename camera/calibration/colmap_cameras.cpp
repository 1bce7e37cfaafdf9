#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>

#include "camera/calibration/colmap_models.h"
#include "camera/calibration/formats.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/yaml/camera_values.h"

// COLMAP's cameras.txt: one camera per line,
//   CAMERA_ID MODEL WIDTH HEIGHT PARAMS...
// and in the refractive fork (She et al. 2024) PARAMS is followed by FLATPORT or DOMEPORT and its
// eight numbers. '#' starts a comment line.

namespace uw {
namespace {

constexpr std::size_t k_most_tokens = 64;

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
        if (line.tokens.size() > k_most_tokens) break;  // no camera has this many
    }
    return line;
}

/// Visits all lines that are neither empty nor comments.
template <class Visit>
void for_each_line(std::string_view text, Visit visit) {
    int number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
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
    constexpr auto k_mend = "write ID MODEL WIDTH HEIGHT PARAMS...";
    if (line.tokens.size() < 5 || line.tokens.size() > k_most_tokens)
        line.value(0, "").fail(fmt::format("is not a COLMAP camera; {}", k_mend));
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

std::string camera_line(const CameraDesc& camera, bool with_port) {
    const ColmapParameters model = colmap_model_of(camera);
    std::string line = fmt::format("1 {} {} {} {}", model.name, camera.width, camera.height,
                                   fmt::join(model.values, " "));
    if (with_port && camera.port) {
        const ColmapParameters port = port_model_of(*camera.port);
        line += fmt::format(" {} {}", port.name, fmt::join(port.values, " "));
    }
    return line + "\n";
}

}  // namespace

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
    text += camera_line(camera, true);
    if (camera.port)
        text += "# Stock COLMAP does not support ports. The camera alone, as it is in air:\n# " +
                camera_line(camera, false);
    return text;
}

}  // namespace uw
