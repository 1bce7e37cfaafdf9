#pragma once

#include <optional>
#include <vector>

#include "cli/render/render_arguments.h"
#include "render/scene_variations.h"

namespace uw {

/// The scenes of a run as the arguments request them: the scene itself, or its variations.
class RunScenes {
  public:
    /// Reads the scene, or what its variations draw. Throws as load_scene and SceneVariations;
    /// UsageError for a scene without variations, or one that is not among the set.
    explicit RunScenes(const RenderArguments& arguments);

    /// The variations of the whole set, if one is requested, else those to render: in the order of
    /// their images. One that is none: the scene itself.
    const std::vector<std::optional<int>>& all() const { return all_; }
    /// Whether a variation of the set is to be rendered.
    bool is_wanted(std::optional<int> variation) const;

    /// One of these scenes, with the arguments applied, until another is requested: it is read for
    /// the occasion. Throws as load_scene and SceneVariations::scene; UsageError for arguments that
    /// do not suit it.
    const SceneDesc& of(std::optional<int> variation);

    /// Only of variations.
    const SceneVariations& variations() const { return *variations_; }

  private:
    const RenderArguments& arguments_;
    std::optional<SceneVariations> variations_;
    std::vector<std::optional<int>> all_;
    std::optional<int> current_;
    std::optional<SceneDesc> scene_;  // that of the current
};

}  // namespace uw
