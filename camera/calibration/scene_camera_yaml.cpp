#include <fmt/format.h>

#include <array>

#include "camera/calibration/formats.h"

// The camera section of a scene file, ready to paste.

namespace uw {
namespace {

std::string glass(double thickness, const auto& port) {
    return fmt::format("thickness: {}, n_air: {}, n_glass: {}, n_water: {}{}{}", thickness,
                       port.n_air, port.n_glass, port.n_water,
                       port.fresnel ? ", fresnel: true" : "",
                       port.radiance_in_air ? ", radiance_in: air" : "");
}

std::string port_text(const PortDesc& port) {
    if (const auto* dome = std::get_if<DomePortDesc>(&port)) {
        const std::array<double, 3> center{dome->center.x, dome->center.y, dome->center.z};
        return fmt::format("  port: {{type: dome, center: {}, radius: {}, {}}}\n",
                           number_list(center), dome->radius, glass(dome->thickness, *dome));
    }
    const auto& flat = std::get<FlatPortDesc>(port);
    const std::array<double, 3> normal{flat.normal.x, flat.normal.y, flat.normal.z};
    return fmt::format("  port: {{type: flat, normal: {}, distance: {}, {}}}\n",
                       number_list(normal), flat.distance, glass(flat.thickness, flat));
}

}  // namespace

std::string write_scene_camera(const CameraDesc& camera) {
    const IntrinsicsDesc& i = camera.intrinsics;
    std::string text = fmt::format(
        "camera:\n  resolution: [{}, {}]\n  intrinsics: {{fx: {}, fy: {}, cx: {}, cy: {}}}\n",
        camera.width, camera.height, i.fx, i.fy, i.cx, i.cy);
    const DistortionDesc& d = camera.distortion;
    if (d.model == DistortionDesc::Model::fisheye) {
        text += fmt::format("  distortion: {{model: fisheye, k: {}}}\n",
                            number_list(std::span(d.k).first(4)));
    } else if (is_distorted(d)) {
        const std::size_t count = has_radial_above(d, 3) ? 6 : 3;
        text += fmt::format("  distortion: {{model: brown-conrady, k: {}, p: {}}}\n",
                            number_list(std::span(d.k).first(count)), number_list(d.p));
    }
    if (camera.port) text += port_text(*camera.port);
    return text;
}

}  // namespace uw
