#include "render/run/exposure.h"

#include "core/image/image_file.h"
#include "core/image/pixel_image.h"

namespace uw {

RunExposure::RunExposure(const PreviewExposure& wanted) : kind_(wanted.kind) {
    if (kind_ == PreviewExposure::Kind::fixed) of_all_ = wanted.factor;
}

void RunExposure::keep(double first) {
    if (kind_ == PreviewExposure::Kind::first && !of_all_) of_all_ = first;
}

std::optional<double> RunExposure::of(const Film& film) {
    // A black image has none of its own. Rounded as its file states it, so that a run that
    // continues a sequence uses the same.
    if (kind_ == PreviewExposure::Kind::first && !of_all_)
        if (const auto own = automatic_exposure(film)) of_all_ = as_stated_in_png(*own);
    return of_all_;
}

}  // namespace uw
