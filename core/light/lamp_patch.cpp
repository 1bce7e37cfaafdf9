#include "core/light/lamp_patch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>

namespace uw {

double LampFrame::area() const {
    if (extent.shape == LampExtentDesc::Shape::disk)
        return std::numbers::pi * extent.radius * extent.radius;
    return extent.width * extent.height;
}

Vector3 LampFrame::at(const UnitPoint& place) const {
    if (extent.shape == LampExtentDesc::Shape::disk) {
        const double radius = extent.radius * std::sqrt(place.u);
        const double angle = 2 * std::numbers::pi * place.v;
        return radius * std::cos(angle) * x + radius * std::sin(angle) * y;
    }
    // The even steps of u go along the longer side.
    auto [u, v] = place;
    if (extent.width < extent.height) std::swap(u, v);
    return (u - 0.5) * extent.width * x + (v - 0.5) * extent.height * y;
}

Vector3 LampPatch::at(const UnitPoint& place) const {
    return frame.at({begin.u + place.u * (end.u - begin.u), begin.v + place.v * (end.v - begin.v)});
}

namespace {

// How long and how wide the unit square is on the surface, where a disk is as wide as in the mean.
UnitPoint lengths_of(const LampExtentDesc& extent) {
    if (extent.shape == LampExtentDesc::Shape::disk)
        return {extent.radius, 4.0 / 3 * std::numbers::pi * extent.radius};
    return {std::max(extent.width, extent.height), std::min(extent.width, extent.height)};
}

class Division {
  public:
    Division(const std::vector<UnitPoint>& places, const UnitPoint& lengths,
             std::vector<LampPatch>& patches)
        : places_(places), lengths_(lengths), patches_(patches) {}

    void divide(std::span<std::size_t> points, const UnitPoint& begin, const UnitPoint& end) {
        if (points.size() == 1) {
            patches_[points.front()].begin = begin;
            patches_[points.front()].end = end;
            return;
        }
        const bool is_long = (end.u - begin.u) * lengths_.u >= (end.v - begin.v) * lengths_.v;
        double UnitPoint::*const along = is_long ? &UnitPoint::u : &UnitPoint::v;
        const std::size_t half = points.size() / 2;
        std::ranges::sort(points, {}, [&](std::size_t i) { return places_[i].*along; });
        const double share = static_cast<double>(half) / static_cast<double>(points.size());
        UnitPoint first_end = end, second_begin = begin;
        first_end.*along = second_begin.*along = begin.*along + share * (end.*along - begin.*along);
        divide(points.first(half), begin, first_end);
        divide(points.subspan(half), second_begin, end);
    }

  private:
    const std::vector<UnitPoint>& places_;
    UnitPoint lengths_;
    std::vector<LampPatch>& patches_;
};

}  // namespace

std::vector<LampPatch> divide(const LampFrame& frame, const Point3& centre,
                              const std::vector<UnitPoint>& places) {
    const double area = frame.area() / static_cast<double>(places.size());
    std::vector<LampPatch> patches(places.size(),
                                   {frame, centre, {}, {}, std::sqrt(area * std::numbers::inv_pi)});
    std::vector<std::size_t> points(places.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = i;
    Division(places, lengths_of(frame.extent), patches).divide(points, {0, 0}, {1, 1});
    return patches;
}

}  // namespace uw
