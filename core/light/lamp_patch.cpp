#include "core/light/lamp_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <span>
#include <utility>

namespace uw {

namespace {

constexpr int k_points_along = 8;  // for a patch's mean and covariance, to 2 % of the latter

// Inverts the cumulative distribution of a sphere's light: returns the r/R within which a fraction
// `inside` of it is emitted. With r = R sin t, the light within r is proportional to t - sin t cos
// t, whose derivative is 2 sin^2 t.
double invert_sphere_radius(double inside) {
    const double wanted = 0.5 * std::numbers::pi * inside;
    double low = 0, high = 0.5 * std::numbers::pi;
    double t = std::min(std::cbrt(1.5 * wanted), high);
    constexpr int k_steps = 60;
    for (int i = 0; i < k_steps && high - low > 1e-12; ++i) {
        const double sine = std::sin(t), excess = t - sine * std::cos(t) - wanted;
        (excess > 0 ? high : low) = t;
        const double next = t - excess / (2 * sine * sine);
        t = next > low && next < high ? next : 0.5 * (low + high);
    }
    return std::sin(t);
}

// The same, to 1e-6, by a table over the cube root of `inside`, which makes it smooth at 0.
double sphere_radius(double inside) {
    constexpr std::size_t k_count = 1024;
    static const std::array<double, k_count + 1> table = [] {
        std::array<double, k_count + 1> radii{};
        for (std::size_t i = 0; i <= k_count; ++i) {
            const double root = static_cast<double>(i) / k_count;
            radii[i] = invert_sphere_radius(root * root * root);
        }
        return radii;
    }();
    const double place = std::cbrt(std::clamp(inside, 0.0, 1.0)) * k_count;
    const auto i = std::min(static_cast<std::size_t>(place), k_count - 1);
    return std::lerp(table[i], table[i + 1], place - static_cast<double>(i));
}

Vector3 in_sphere(double radius, const UnitPoint& place) {
    const double r = radius * sphere_radius(place.w);
    const double cosine = 2 * place.u - 1, sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double angle = 2 * std::numbers::pi * place.v;
    return r * Vector3(sine * std::cos(angle), sine * std::sin(angle), cosine);
}

}  // namespace

double LampFrame::area() const {
    if (extent.shape == LampExtentDesc::Shape::rectangle) return extent.width * extent.height;
    return std::numbers::pi * extent.radius * extent.radius;
}

Vector3 LampFrame::at(const UnitPoint& place) const {
    if (extent.shape == LampExtentDesc::Shape::disk) {
        const double radius = extent.radius * std::sqrt(place.u);
        const double angle = 2 * std::numbers::pi * place.v;
        return radius * std::cos(angle) * x + radius * std::sin(angle) * y;
    }
    if (extent.shape == LampExtentDesc::Shape::sphere) {
        const Vector3 inside = in_sphere(extent.radius, place);
        return inside.x * x + inside.y * y + inside.z * glm::cross(x, y);
    }
    // The even steps of u go along the longer side.
    auto [u, v, w] = place;
    if (extent.width < extent.height) std::swap(u, v);
    return (u - 0.5) * extent.width * x + (v - 0.5) * extent.height * y;
}

Vector3 LampPatch::at(const UnitPoint& place) const {
    return frame.at({begin.u + place.u * (end.u - begin.u), begin.v + place.v * (end.v - begin.v),
                     begin.w + place.w * (end.w - begin.w)});
}

namespace {

// Calls `visit` with points that fill a patch evenly.
void for_each_point(const LampPatch& patch, const std::function<void(const Vector3&)>& visit) {
    const int deep = patch.frame.is_flat() ? 1 : k_points_along;
    const auto place = [](int i, int count) { return (i + 0.5) / count; };
    for (int i = 0; i < k_points_along; ++i)
        for (int j = 0; j < k_points_along; ++j)
            for (int k = 0; k < deep; ++k)
                visit(
                    patch.at({place(i, k_points_along), place(j, k_points_along), place(k, deep)}));
}

double count_of_points(const LampPatch& patch) {
    return std::pow(k_points_along, patch.frame.is_flat() ? 2 : 3);
}

}  // namespace

Vector3 LampPatch::middle() const {
    Vector3 sum(0);
    for_each_point(*this, [&](const Vector3& point) { sum += point; });
    return sum / count_of_points(*this);
}

Matrix3 LampPatch::covariance() const {
    const Vector3 middle = this->middle();
    Matrix3 sum(0);
    for_each_point(*this, [&](const Vector3& point) {
        sum += glm::outerProduct(point - middle, point - middle);
    });
    return sum / count_of_points(*this);
}

namespace {

// The mean lengths of the unit cube's sides on the surface; flat ones have no third.
UnitPoint lengths_of(const LampExtentDesc& extent) {
    switch (extent.shape) {
        case LampExtentDesc::Shape::disk:
            return {extent.radius, 4.0 / 3 * std::numbers::pi * extent.radius};
        case LampExtentDesc::Shape::sphere: {
            const double mean = 8 / (3 * std::numbers::pi) * extent.radius;  // distance from centre
            return {std::numbers::pi * mean, 0.5 * std::numbers::pi * std::numbers::pi * mean,
                    extent.radius};
        }
        case LampExtentDesc::Shape::rectangle:
            break;
    }
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
        const auto length = [&](double UnitPoint::*side) {
            return (end.*side - begin.*side) * lengths_.*side;
        };
        double UnitPoint::*along = &UnitPoint::u;
        for (double UnitPoint::*const side : {&UnitPoint::v, &UnitPoint::w})
            if (length(side) > length(along)) along = side;
        const std::size_t half = points.size() / 2;
        std::ranges::sort(points, {}, [&](std::size_t i) { return places_[i].*along; });
        const double fraction = static_cast<double>(half) / static_cast<double>(points.size());
        UnitPoint first_end = end, second_begin = begin;
        first_end.*along = second_begin.*along =
                               begin.*along + fraction * (end.*along - begin.*along);
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
    Division(places, lengths_of(frame.extent), patches).divide(points, {0, 0, 0}, {1, 1, 1});
    return patches;
}

}  // namespace uw
