#include <fmt/format.h>

#include "camera/calibration/colmap_models.h"
#include "camera/calibration/formats.h"
#include "core/scene/yaml/camera_values.h"

// Calibmar's calibration.yaml: COLMAP's models by name and list of parameters, image corner at (0,
// 0) (Calibmar adds the half pixel to what OpenCV detects), lengths in metres.

namespace uw {

bool looks_like_calibmar(const ConfigNode& root) {
    return root.find("non_svp_model") != nullptr ||
           (root.find("model") != nullptr && root.find("parameters") != nullptr);
}

Calibration read_calibmar(const ConfigValue& root) {
    constexpr auto k_mend = "give model, parameters, width and height as Calibmar writes them";
    Calibration result;
    result.format = CalibrationFormat::calibmar;
    const ConfigValue model = require_value(root, "model", k_mend);
    const ConfigValue parameters = require_value(root, "parameters", k_mend);
    read_colmap_model(model, parameters.list(k_mend), result.desc);
    const ConfigValue width = require_value(root, "width", k_mend);
    read_resolution(width, width, require_value(root, "height", k_mend), result.desc);
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
