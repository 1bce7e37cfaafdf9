#include "core/light/glass_shaded_emitter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/light/point_emitter.h"
#include "core/light/sunlight.h"

namespace uw {

GlassShadedEmitter::GlassShadedEmitter(std::shared_ptr<const Emitter> original,
                                       std::shared_ptr<const GlassOptics> glass, std::size_t band)
    : Emitter(original->patch()),
      original_(std::move(original)),
      glass_(std::move(glass)),
      band_(band) {
    const Bounds bounds = glass_->bounds_of_all();
    if (!bounds.empty() && !original_->is_mirrored())
        ball_ = {bounds.center(), 0.5 * bounds.diagonal()};
}

double GlassShadedEmitter::focus(const Point3& x) const {
    const double focused = original_->focus(x);
    return focused > 0 ? focused * glass_->transmittance(origin(x), x, band_) : 0;
}

void GlassShadedEmitter::focus(const Ray& ray, std::span<const double> s,
                               std::span<double> values) const {
    original_->focus(ray, s, values);
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (values[i] == 0) continue;
        const Point3 x = ray.at(s[i]);
        values[i] *= glass_->transmittance(origin(x), x, band_);
    }
}

Interval GlassShadedEmitter::shadow(const Ray& ray, const Interval& interval) const {
    if (!ball_) return interval;
    const auto& [center, radius] = *ball_;
    if (const Sunlight* const sun = sunlight()) {
        // |(o - c + s d) x w| < r
        const Vector3 from = glm::cross(ray.origin - center, sun->direction);
        const Vector3 along = glm::cross(ray.direction, sun->direction);
        const double a = glm::dot(along, along), b = glm::dot(from, along);
        const double c = glm::dot(from, from) - radius * radius;
        if (a < 1e-12) return c < 0 ? interval : Interval{};
        const double root = b * b - a * c;
        if (root < 0) return {};
        return {std::max(interval.begin, (-b - std::sqrt(root)) / a),
                std::min(interval.end, (-b + std::sqrt(root)) / a)};
    }
    const Point3 position = origin({});
    const Vector3 axis = center - position;
    const double length = glm::length(axis);
    if (length <= radius) return interval;
    return beam_of({axis / length, std::sqrt(1 - radius * radius / (length * length))}, position,
                   ray, interval);
}

// Most of the light that a ray collects is near the lamp: the octaves around the nearest point are
// searched one by one.
void GlassShadedEmitter::append_profile_breaks(const Ray& ray, const Interval& interval,
                                               std::vector<double>& s) const {
    original_->append_profile_breaks(ray, interval, s);
    const Interval all = shadow(ray, interval);
    if (!(all.length() > 0)) return;
    const LampPassage passage = this->passage(ray);
    const auto origin_of = [&](const Point3& x) { return origin(x); };
    std::vector<double> ends{all.begin, all.end};
    if (!passage.parallel) {
        const double nearest = std::max(passage.distance, 1e-3);
        for (double step = nearest; step < all.length(); step *= 4)
            for (const double end : {passage.foot - step, passage.foot + step})
                if (end > all.begin && end < all.end) ends.push_back(end);
        std::ranges::sort(ends);
    }
    s.insert(s.end(), {all.begin, all.end});
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        glass_->append_edges(ray, {ends[i], ends[i + 1]}, origin_of, s);
}

bool GlassShadedEmitter::equals(const Emitter& other) const {
    const auto& shaded = static_cast<const GlassShadedEmitter&>(other);
    return *original_ == *shaded.original_ && *glass_ == *shaded.glass_ && band_ == shaded.band_;
}

}  // namespace uw
