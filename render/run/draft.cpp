#include "render/run/draft.h"

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "render/scene_loading.h"

namespace uw {

void shrink_image(CameraDesc& camera, int max_width, int max_height) {
    const int width = std::min(camera.width, max_width);
    const double height = static_cast<double>(camera.height) * width / camera.width;
    resize_image(camera, width, std::clamp(static_cast<int>(std::lround(height)), 1, max_height));
}

ImageScene draft_of(const ImageScene& scene, int max_width, int max_height) {
    return scene.with([&](SceneDesc& desc) {
        ImageRequest draft;
        draft.quality = "draft";
        apply_request(draft, desc);
        shrink_image(desc.camera, max_width, max_height);
    });
}

}  // namespace uw
