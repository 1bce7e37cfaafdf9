#pragma once

#include <cstddef>

#include "tests/support/film_rendering.h"
#include "tests/support/planes_scene.h"

/// Scenes with forward scatter.
namespace uw::test {

using Shape = ForwardScatterDesc::Shape;

inline ForwardScatterDesc forward(double K, Shape shape = Shape::gaussian) {
    ForwardScatterDesc desc;
    desc.K = K;
    desc.G = 0.05;
    desc.B = 0.05;
    desc.shape = shape;
    return desc;
}

inline SceneDesc scattering(SceneDesc desc, const ForwardScatterDesc& how) {
    desc.water.forward_scatter = how;
    return desc;
}

inline double attenuation(std::size_t band) {
    const WaterDesc water = hg_water(0.9);
    return (*water.absorption)[band] + water.scattering->b[band];
}

// A wall, a box in front of it and two lamps: depth edges and shadows.
inline SceneDesc staged() {
    SceneDesc desc = uniform_scene({1, -0.5, 0});
    desc.camera.width = 32;
    desc.camera.height = 24;
    desc.camera.intrinsics = {28, 28, 16, 12};
    desc.geometry.push_back(box({-0.5, -0.4, 1.5}, {0.1, 0.2, 1.8}));
    desc.lamps.push_back(isotropic_lamp({-1.2, 0.3, 0.4}, 80));
    desc.lamps[1].name = "second";
    return desc;
}

}  // namespace uw::test
