#pragma once

#include <utility>

#include "render/renderer.h"

namespace uw::test {

/// The image of a scene, by a renderer of its own.
inline Film image_of(SceneDesc desc, const RenderOptions& options) {
    Renderer renderer;
    renderer.set_scene(std::move(desc));
    renderer.render(options);
    return renderer.release_film();
}

}  // namespace uw::test
