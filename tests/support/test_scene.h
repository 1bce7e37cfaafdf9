#pragma once

#include <memory>
#include <vector>

#include "core/passes/pixel_renderer.h"
#include "render/renderer.h"
#include "tests/support/geometry_descs.h"

namespace uw::test {

/// A camera at the origin looking along +z (camera axes = world axes), 60 degrees wide, no port.
SceneDesc pinhole_scene(int width, int height);

/// Explicit water: absorption, scattering with one Henyey-Greenstein phase function, three bands.
WaterDesc hg_water(double g);

LampDesc isotropic_lamp(const Point3& position, double intensity);
GeometryDesc plane_at_z(double z);

/// A scene with its integrator, ready to render pixels.
class TestScene {
  public:
    explicit TestScene(const SceneDesc& desc, const DeepShadowOptions& options = {});

    const AssembledScene& assembled() const { return scene_; }
    const DeepShadows& light() const { return light_; }
    const Integrator& integrator() const { return *transport_.integrator; }
    PixelResult pixel(int x, int y) const;
    std::vector<PixelResult> image() const;

  private:
    SceneCache cache_;
    AssembledScene scene_;
    DeepShadows light_;
    LightTransport transport_;
    std::unique_ptr<PixelRenderer> pixels_;
};

}  // namespace uw::test
