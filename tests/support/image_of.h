#pragma once

#include <utility>

#include "render/renderer.h"

namespace uw::test {

/// The image of a scene, by a renderer of its own.
inline Film image_of(ImageScene scene, const RenderOptions& options) {
    Renderer renderer;
    renderer.set_scene(std::move(scene));
    renderer.render(options);
    return renderer.release_film();
}
inline Film image_of(const SceneDesc& desc, const RenderOptions& options) {
    return image_of(ImageScene(SceneDesc(desc)), options);
}

}  // namespace uw::test
