#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/scene_assembly.h"

namespace uw {

/// What a method says of every pixel of a scene, row by row, one sample at each pixel's centre.
struct MethodImage {
    std::vector<Spectrum> direct;       // W m^-2 sr^-1
    std::vector<Spectrum> backscatter;  // W m^-2 sr^-1
};

/// Makes the integrator that is on trial; tests slip in wrong ones here.
using IntegratorFactory = std::function<std::unique_ptr<Integrator>(
    const AssembledScene& scene,
    const std::vector<std::shared_ptr<const LampLightField>>& light_fields)>;

/// A scene on trial, assembled, with its lamps splatted.
struct TrialScene {
    AssembledScene scene;
    std::vector<std::shared_ptr<const LampLightField>> light_fields;

    int width() const { return scene.camera->width(); }
    int height() const { return scene.camera->height(); }
};

/// Assembles `desc` and splats its lamps.
TrialScene make_trial(const SceneDesc& desc);

/// `trial` with its grids replaced by their mean over the field's bounds: uniform water.
/// `desc` is the description that `trial` was made from.
TrialScene homogenised(const TrialScene& trial, const SceneDesc& desc);

/// `trial`, whose water is uniform, with that water moved into a VDB grid of constant value: the
/// grid is written to a file and read back, and what stays outside it is vacuum. It reaches from
/// all cameras, lamps and surfaces to where 15 optical depths have passed.
TrialScene with_constant_grid(const TrialScene& trial, const SceneDesc& desc);

/// Renders every pixel with `integrator`; stops with Interrupted when `proceed` says no.
MethodImage render_method(const TrialScene& trial, const Integrator& integrator,
                          const std::function<bool()>& proceed);

/// Pixels whose water ray meets no shadow edge and no hard edge of a lamp's beam, row by row: where
/// a sum over slabs converges as their thickness squared.
std::vector<char> smooth_pixels(const TrialScene& trial);

}  // namespace uw
