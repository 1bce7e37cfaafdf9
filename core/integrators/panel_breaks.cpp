#include "core/integrators/panel_breaks.h"

#include <algorithm>

namespace uw {

void PanelBreaks::reset(const Interval& stretch) {
    stretch_ = stretch;
    candidates_.clear();
}

const std::vector<double>& PanelBreaks::kept() {
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.s < b.s; });
    candidates_.push_back({stretch_.end, 0});
    kept_.assign(1, stretch_.begin);
    double spacing_of_last = 0;
    for (const Candidate& candidate : candidates_) {
        const double since_last = candidate.s - kept_.back();
        if (since_last < candidate.spacing) continue;
        // An edge replaces a mark just before it.
        if (candidate.spacing == 0 && since_last < spacing_of_last) kept_.pop_back();
        kept_.push_back(candidate.s);
        spacing_of_last = candidate.spacing;
    }
    return kept_;
}

}  // namespace uw
