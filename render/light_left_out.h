#pragma once

#include <optional>
#include <string>

#include "core/scene/scene_desc.h"
#include "render/assembled_scene.h"

namespace uw {

/// The fraction of all light that an image of single scattering leaves out, as means over the image
/// and the bands, and its standard error.
struct LightLeftOut {
    double fraction = 0, error = 0;

    /// Whether it is so much that an image of single scattering should come with a note.
    bool matters() const { return fraction > 0.05; }
};

/// Estimates that fraction by a few light paths all over the image. They take about a tenth of the
/// work of the image, at most some thousand vertices, and are the same in every run. None for a
/// scene that is rendered with multiple scattering, or that has no light.
std::optional<LightLeftOut> estimate_light_left_out(const AssembledScene& scene);

/// Returns the settings with which a scene is rendered with multiple scattering:
/// "render.scattering: multiple" and what else it needs.
std::string settings_of_all_light(const SceneDesc& scene);

/// Returns a note, one line, of how much is left out and how to render it, if it matters.
std::optional<std::string> left_out_note(const AssembledScene& scene,
                                         const std::optional<LightLeftOut>& left_out);

}  // namespace uw
