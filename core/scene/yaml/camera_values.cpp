#include "core/scene/yaml/camera_values.h"

#include <fmt/format.h>

#include <cmath>

namespace uw {
namespace {

constexpr int k_longest_side = 32768;
constexpr long long k_most_pixels = 1LL << 28;

}  // namespace

void read_resolution(const ConfigValue& both, const ConfigValue& width, const ConfigValue& height,
                     CameraDesc& camera) {
    constexpr auto k_mend = "give [width, height] in pixels";
    camera.width = width.integer(1, k_longest_side, k_mend);
    camera.height = height.integer(1, k_longest_side, k_mend);
    const long long pixels = static_cast<long long>(camera.width) * camera.height;
    if (pixels > k_most_pixels) {
        both.fail(fmt::format("{} x {} are more than {} pixels; give a smaller image", camera.width,
                              camera.height, k_most_pixels));
    }
}

double read_refractive_index(const ConfigValue& value) {
    return value.within(1, 3, "give a refractive index, such as 1.0, 1.49 or 1.334");
}

void check_port_normal(const ConfigValue& at, const Vector3& normal) {
    if (normal.z > 0) return;
    at.fail(
        "must point away from the camera (z > 0), found z <= 0; camera axes are x right, y down, "
        "z forward");
}

void check_dome(const ConfigValue& at, const DomePortDesc& dome) {
    const double offset = glm::length(from_origin(dome.center));
    if (offset < dome.radius) return;
    at.fail(
        fmt::format("the camera is outside its dome: it is {} m from the centre, but the inner "
                    "radius is {} m; give lengths in metres and the centre in camera axes",
                    offset, dome.radius));
}

}  // namespace uw
