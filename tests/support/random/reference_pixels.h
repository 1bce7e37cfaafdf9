#pragma once

#include <vector>

#include "core/light/lamp.h"
#include "render/image_scene.h"
#include "render/renderer.h"

namespace uw::test {

/// Whether a plane is so near to a lamp that shadow rays of some metres take it for the lamp's own
/// (Surfaces::occluded): the reference integrator sees light behind it, the fast one, whose rays
/// begin at the lamp, does not.
bool is_at_plane(const Lamp& lamp, const SceneDesc& scene);

/// Single pixels of a scene by the reference integrator.
class ReferencePixels {
  public:
    explicit ReferencePixels(const ImageScene& scene);

    /// The total of all light in a pixel, as images hold it, per band.
    std::vector<double> at(int x, int y);

  private:
    std::size_t bands_, first_;  // how many channels hold the total, and the first of them
    Renderer renderer_;
};

}  // namespace uw::test
