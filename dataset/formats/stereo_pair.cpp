#include "dataset/formats/stereo_pair.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"

namespace uw {

namespace {

// Of a rig typed with six digits.
constexpr double k_parallel = 1e-6;

bool is_pinhole(const CameraDesc& camera) {
    const DistortionDesc none;
    return !camera.port && camera.distortion == none;
}

}  // namespace

bool is_rectified(const SceneDesc& scene) {
    if (scene.cameras.size() < 2) return false;
    const CameraDesc& left = scene.cameras[0].camera;
    const CameraDesc& right = scene.cameras[1].camera;
    if (!is_pinhole(left) || !is_pinhole(right) || left.width != right.width ||
        left.height != right.height || left.intrinsics.fx != right.intrinsics.fx ||
        left.intrinsics.fy != right.intrinsics.fy || left.intrinsics.cy != right.intrinsics.cy)
        return false;
    const Affine left_from_right = left.world_from_camera.inverse() * right.world_from_camera;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(left_from_right.linear()[i][j] - (i == j ? 1 : 0)) > k_parallel)
                return false;
    const Vector3 t = left_from_right.offset();
    return t.x > 0 && std::abs(t.y) <= k_parallel * t.x && std::abs(t.z) <= k_parallel * t.x;
}

void check_rectified(const DatasetDefinition& definition, const SceneDesc& scene) {
    if (definition.cameras.size() < 2)
        throw UsageError(
            "--format: disparity and kitti are of a pair; give a scene with a rig of two cameras");
    if (!is_rectified(scene))
        throw UsageError(
            "--format: the rig's first two cameras are no rectified pair (equal, without port or "
            "distortion, side by side with parallel axes, the left one first), so that disparity "
            "is not one number per pixel; use --format npy --layers disparity");
}

void check_disparity(const ViewImages& images) {
    // 1e-3 px is what disparity is exact to.
    constexpr double k_along_rows = 1e-3;
    images.for_each_pixel([&](int x, int y) {
        const float across = images.at(Layer::disparity, x, y)[1];
        if (std::isfinite(across) && std::abs(across) > k_along_rows)
            throw InputError(fmt::format(
                "--format disparity: it is {:.3g} px across the rows at pixel {}, {}: the "
                "cameras are not rectified in this frame; use --format npy --layers disparity",
                across, x, y));
    });
}

}  // namespace uw
