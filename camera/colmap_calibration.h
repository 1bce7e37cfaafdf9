#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/camera_desc.h"

namespace uw {

/// A camera model or port of COLMAP, or of its refractive fork, and its parameters, ready to be
/// written. The image corner is (0, 0), as in uwvdb.
struct ColmapParameters {
    std::string_view name;   // "OPENCV", "FLATPORT"
    std::string_view names;  // of the parameters, in order: "fx fy cx cy k1 k2 p1 p2"
    std::vector<double> values;
};
/// The simplest model that covers all of the camera's distortion, with its parameters.
ColmapParameters colmap_model_of(const CameraDesc& camera);
/// The model of a port, lengths in metres.
ColmapParameters port_model_of(const PortDesc& port);
/// The camera's line of COLMAP's cameras.txt, `with_port` with that of the refractive fork.
std::string colmap_camera_line(std::size_t id, const CameraDesc& camera, bool with_port);

}  // namespace uw
