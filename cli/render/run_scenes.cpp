#include "cli/render/run_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "render/scene_loading.h"

namespace uw {

RunScenes::RunScenes(const RenderArguments& arguments) : arguments_(arguments) {
    if (arguments.is_scene_itself()) {
        all_.emplace_back();
        return;
    }
    variations_.emplace(arguments.scene, arguments.overrides);
    if (!variations_->desc())
        throw UsageError(
            fmt::format("--variation{}: the scene has none; add a section such as "
                        "variations: {{keys: {{lamps[0].power: {{uniform: [10, 30]}}}}}}",
                        arguments.variation_count ? "s" : ""));
    if (!arguments.variation_count) {
        all_.assign(arguments.variations.begin(), arguments.variations.end());
        return;
    }
    for (int i = 0; i < *arguments.variation_count; ++i) all_.emplace_back(i);
    for (const int wanted : arguments.variations)
        if (wanted >= *arguments.variation_count)
            throw UsageError(fmt::format("--variation {}: there are --variations {}, from 0 to {}",
                                         wanted, *arguments.variation_count,
                                         *arguments.variation_count - 1));
}

bool RunScenes::is_wanted(std::optional<int> variation) const {
    const std::vector<int>& wanted = arguments_.variations;
    return !variation || wanted.empty() || std::ranges::find(wanted, *variation) != wanted.end();
}

const SceneDesc& RunScenes::of(std::optional<int> variation) {
    if (scene_ && variation == current_) return *scene_;
    SceneDesc scene = variation ? variations_->scene(*variation)
                                : load_scene(arguments_.scene, arguments_.overrides);
    apply_request(arguments_.image(), scene);
    scene_ = std::move(scene);
    current_ = variation;
    return *scene_;
}

}  // namespace uw
