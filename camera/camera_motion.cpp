#include "camera/camera_motion.h"

namespace uw {

Affine CameraMotion::at(double time) const {
    const auto last = static_cast<double>(poses_.size() - 1);
    const double place = std::clamp((time - span_.begin) / span_.length(), 0.0, 1.0) * last;
    const auto before = std::min(static_cast<std::size_t>(place), poses_.size() - 2);
    const double share = place - static_cast<double>(before);
    const Affine &a = poses_[before], &b = poses_[before + 1];
    return {(1 - share) * a.linear() + share * b.linear(),
            (1 - share) * a.offset() + share * b.offset()};
}

}  // namespace uw
