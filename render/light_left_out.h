#pragma once

#include <optional>
#include <string>

#include "core/scene/scene_desc.h"
#include "render/assembled_scene.h"

namespace uw {

/// The share of all light that an image of single scattering leaves out, as means over the image
/// and the bands, and the share's standard error.
struct LightLeftOut {
    double share = 0, error = 0;

    /// Whether it is more than an image of single scattering may leave out without a word.
    bool matters() const { return share > 0.05; }
};

/// Estimates it by a few light paths all over the image, which are about a tenth of the work that
/// the image is, and at most some thousand vertices: the same in every run. None for a scene that
/// is rendered with all light, or without any.
std::optional<LightLeftOut> estimate_light_left_out(const AssembledScene& scene);

/// What of a scene that is rendered with single scattering is to be set so that it is rendered with
/// all light: "render.scattering: multiple".
std::string settings_of_all_light(const SceneDesc& scene);

/// One line that says so, and how to render it, where it matters.
std::optional<std::string> left_out_note(const AssembledScene& scene,
                                         const std::optional<LightLeftOut>& left_out);

}  // namespace uw
