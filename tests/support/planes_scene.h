#pragma once

#include <vector>

#include "tests/support/test_scene.h"

/// Uniform water for the planes integrator and the others it is compared with.
namespace uw::test {

inline constexpr double k_plane_z = 4;

/// A plane across the view, lit by one lamp of 50 W/sr.
inline SceneDesc uniform_scene(const Point3& lamp) {
    SceneDesc desc = pinhole_scene(16, 12);
    desc.geometry = {plane_at_z(k_plane_z)};
    desc.lamps = {isotropic_lamp(lamp, 50)};
    return desc;
}

/// The same with Kopelevich's particles in the water.
inline SceneDesc kopelevich(SceneDesc desc) {
    desc.water.scattering.reset();
    desc.water.small_ppm = 0.05;
    desc.water.large_ppm = 0.6;
    return desc;
}

/// The same by the planes integrator.
inline SceneDesc with_planes(SceneDesc desc, int count, double near, double far) {
    desc.render.integrator = RenderDesc::Integrator::planes;
    desc.render.planes.count = count;
    desc.render.planes.near = near;
    desc.render.planes.far = far;
    return desc;
}

/// The same with a camera in another pose behind thick, tilted glass.
inline SceneDesc ported(SceneDesc desc) {
    desc.camera.port =
        FlatPortDesc{glm::normalize(Vector3(0.05, -0.1, 1)), 0.02, 0.04, 1.0, 1.49, 1.334};
    desc.camera.world_from_camera =
        Affine::translation({0.3, 0.2, -0.1}) * Affine::rotation_xyz_degrees({3, -5, 10});
    return desc;
}

/// The difference between the backscatter of two images.
struct Difference {
    double rms = 0, worst = 0;  // relative, per pixel and band
};

inline Difference difference(const std::vector<PixelResult>& image,
                             const std::vector<PixelResult>& truth) {
    Difference d;
    for (std::size_t i = 0; i < image.size(); ++i) {
        for (std::size_t band = 0; band < 3; ++band) {
            const double relative = image[i].backscatter[band] / truth[i].backscatter[band] - 1;
            d.worst = std::max(d.worst, std::abs(relative));
            d.rms += relative * relative;
        }
    }
    d.rms = std::sqrt(d.rms / (3.0 * static_cast<double>(image.size())));
    return d;
}

}  // namespace uw::test
