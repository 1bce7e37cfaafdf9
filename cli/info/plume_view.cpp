#include "cli/info/plume_view.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "media/volumes/grid_field.h"
#include "render/renderer.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

// What is sought: a contrast well above what is plain to see, as other water and lamps will have
// less, rays that see through most of the volume, and a volume that is no black shape.
constexpr double k_wanted_contrast = 0.6;
constexpr double k_most_depth = 2.5;
constexpr double k_least_brightness = 0.03;
constexpr int k_most_drafts = 8;

/// Drafts of one scene with its volume at different concentrations.
class Drafts {
  public:
    Drafts(const SceneProposal& proposal, const VolumeDesc& volume, int width) {
        SceneDesc desc = load_scene_text(proposal_yaml(proposal), "proposal.yaml");
        desc.volumes = {volume};
        make_draft(desc, width);
        renderer_.set_scene(std::move(desc));
        for (const LoadedVolume& loaded : renderer_.assemble().volumes)
            grids_.insert(grids_.end(), loaded.grids.begin(), loaded.grids.end());
        set_grids({});
        renderer_.render();
        without_.emplace(renderer_.release_film());
    }

    DraftContrast at(double factor) {
        std::vector<GridVolume> grids;
        for (const GridVolume& grid : grids_) grids.push_back(grid.scaled(factor));
        set_grids(std::move(grids));
        const Film& with = renderer_.render();
        return compare_drafts(renderer_.assembled(), with, *without_);
    }

  private:
    void set_grids(std::vector<GridVolume> grids) {
        renderer_.edit([&](AssembledScene& scene) {
            scene.field = std::make_shared<GridField>(std::move(grids),
                                                      scene.water.medium.constituent_count());
        });
    }

    Renderer renderer_;
    std::vector<GridVolume> grids_;
    std::optional<Film> without_;
};

/// Neither opaque nor black.
bool is_fit(const DraftContrast& draft) {
    return draft.depth <= k_most_depth && draft.brightness >= k_least_brightness;
}

bool is_good(const DraftContrast& draft) {
    return is_fit(draft) && draft.contrast >= k_wanted_contrast;
}

/// Whether `a` is to be preferred: what is fit if it is plain to see, then the clearer, up to what
/// is wanted, then the less opaque.
bool is_better(const DraftContrast& a, const DraftContrast& b) {
    const auto will_do = [](const DraftContrast& d) {
        return is_fit(d) && d.contrast >= k_plain_to_see;
    };
    if (will_do(a) != will_do(b)) return will_do(a);
    const auto clear = [](const DraftContrast& d) {
        return std::min(d.contrast, k_wanted_contrast);
    };
    return clear(a) > clear(b) * 1.02 || (clear(a) >= clear(b) && a.depth < b.depth);
}

/// Raises or lowers the concentrations until the draft is good, or no longer becomes better.
std::pair<double, DraftContrast> best_factor(Drafts& drafts, DraftContrast best) {
    double factor = 1, best_factor = 1;
    const bool raise = best.contrast < k_wanted_contrast && best.depth < k_most_depth;
    for (int n = 1; n < k_most_drafts && !is_good(best); ++n) {
        // Where most of the volume is far thinner than its densest part, in one step.
        const double step = std::clamp(1 / std::max(best.depth, 1e-12), 2.0, 1e9);
        factor *= raise ? step : 0.5;
        const DraftContrast draft = drafts.at(factor);
        if (!is_better(draft, best)) break;
        best = draft;
        best_factor = factor;
    }
    return {best_factor, best};
}

}  // namespace

PlumeView view_plume(const VolumeDesc& volume, const Bounds& bounds) {
    PlumeView best;
    int width = k_draft_width;
    for (const char* water : {"jerlov-II", "jerlov-IB"}) {
        PlumeView view;
        view.proposal = propose_scene(bounds);
        view.proposal.water = water;
        std::optional<Drafts> drafts(std::in_place, view.proposal, volume, width);
        view.draft = drafts->at(1);
        if (view.draft.seen < k_least_seen && width != k_fine_draft_width) {
            width = k_fine_draft_width;
            drafts.emplace(view.proposal, volume, width);
            view.draft = drafts->at(1);
        }
        std::tie(view.factor, view.draft) = best_factor(*drafts, view.draft);
        if (best.proposal.lamps.empty() || is_better(view.draft, best.draft)) best = view;
        if (is_good(best.draft)) break;
    }
    return best;
}

}  // namespace uw
