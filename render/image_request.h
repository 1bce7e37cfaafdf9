#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/scene/scene_desc.h"

namespace uw {

/// How images are rendered where that is not left to their scene: the options of the command line
/// that have these names.
struct ImageRequest {
    std::string quality;     ///< empty: the scene's
    std::string integrator;  ///< likewise
    std::optional<int> samples;
    std::optional<double> error;             ///< instead of a number of samples
    std::optional<std::array<int, 2>> size;  ///< width, height [pixels]
};

/// Changes what `request` says about how a scene is rendered. Drafts have the samples that the
/// integrator's drafts have, unless others are requested. Throws UsageError, which names the
/// option.
void apply_request(const ImageRequest& request, SceneDesc& scene);

}  // namespace uw
