#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/ray.h"
#include "core/lamps/sunlight.h"

namespace uw {

/// A point in the coordinates of parallel light.
struct LightPoint {
    double u = 0, v = 0;  // across the light [m]
    double depth = 0;     // along it [m]
};

/// The coordinates of a sun's light: a straight ray is a straight line in them, too.
class LightFrame {
  public:
    explicit LightFrame(const Sunlight& sun) : sun_(sun) {
        const Vector3& d = sun.direction;
        const Vector3 least = std::abs(d.x) < 0.6 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
        across_ = glm::normalize(glm::cross(d, least));
        down_ = glm::cross(d, across_);
    }

    const Sunlight& sun() const { return sun_; }
    LightPoint point(const Point3& x) const {
        const Vector3 v = x - sun_.surface.point;
        return {glm::dot(v, across_), glm::dot(v, down_), glm::dot(v, sun_.direction)};
    }
    /// The change of a point's coordinates per metre along a ray.
    LightPoint rates(const Vector3& direction) const {
        return {glm::dot(direction, across_), glm::dot(direction, down_),
                glm::dot(direction, sun_.direction)};
    }
    Point3 world(const LightPoint& p) const {
        return sun_.surface.point + (p.u * across_ + p.v * down_ + p.depth * sun_.direction);
    }
    /// The depth at which the light at (u, v) enters the water.
    double entry_depth(double u, double v) const { return -sun_.length_to(world({u, v, 0})); }

  private:
    Sunlight sun_;
    Vector3 across_{}, down_{};
};

/// A square across a sun's light.
struct LightSquare {
    double u = 0, v = 0;  // its centre
    double half = 0;      // half of an edge [m]

    friend bool operator==(const LightSquare&, const LightSquare&) = default;
};

/// The part of `stretch` of a ray that starts at `begin` and changes by `rates` in which it lies
/// within `half_u` and `half_v` of (u, v); empty if it misses that.
inline Interval inside(const LightPoint& begin, const LightPoint& rates, const Interval& stretch,
                       const LightPoint& middle, double half_u, double half_v) {
    Interval part = stretch;
    const auto clip = [&](double offset, double rate, double half) {
        if (rate == 0) {
            if (std::abs(offset) > half) part.end = part.begin;
            return;
        }
        const double a = (-half - offset) / rate, b = (half - offset) / rate;
        part.begin = std::max(part.begin, std::min(a, b));
        part.end = std::min(part.end, std::max(a, b));
    };
    clip(begin.u - middle.u, rates.u, half_u);
    clip(begin.v - middle.v, rates.v, half_v);
    return part;
}

}  // namespace uw
