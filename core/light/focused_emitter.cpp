#include "core/light/focused_emitter.h"

#include <algorithm>
#include <utility>

#include "core/light/sun_focus.h"

namespace uw {

FocusedEmitter::FocusedEmitter(const WaterSurfaceDesc& surface,
                               std::shared_ptr<const SunFocus> focus)
    : DirectionalEmitter({focus->direction(), surface}), focus_(std::move(focus)) {}

double FocusedEmitter::focus(const Point3& x) const {
    return focus_->at(x);
}

void FocusedEmitter::focus(const Ray& ray, std::span<const double> s,
                           std::span<double> values) const {
    focus_->apply(ray, s, values);
}

// Breaks at every fourth texel, and at wider steps farther away, where a pixel covers more texels.
void FocusedEmitter::append_profile_breaks(const Ray& ray, const Interval& interval,
                                           std::vector<double>& s) const {
    DirectionalEmitter::append_profile_breaks(ray, interval, s);
    constexpr double k_texels = 4, k_relative_step = 0.02;
    const double least = k_texels * focus_->texel() / std::max(1e-3, focus_->slide(ray.direction));
    for (double at = interval.begin + least; at < interval.end;
         at += std::max(least, k_relative_step * at))
        s.push_back(at);
}

bool FocusedEmitter::equals(const Emitter& other) const {
    return DirectionalEmitter::equals(other) &&
           focus_ == static_cast<const FocusedEmitter&>(other).focus_;
}

}  // namespace uw
