#include "edit/session/view_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace uw {

namespace {

constexpr double k_radians = std::numbers::pi / 180;
constexpr int k_circle_points = 64;

Point3 centre_of(const Camera& camera) {
    return camera.world_from_camera() * Point3{};
}

ImagePoint middle_of(const Camera& camera) {
    return {0.5 * camera.width(), 0.5 * camera.height()};
}

// The point at which the line from the image's centre in this direction leaves the image.
ImagePoint rim_point(const Camera& camera, double dx, double dy) {
    const ImagePoint middle = middle_of(camera);
    if (dx == 0 && dy == 0) dy = 1;
    const double tx = dx == 0 ? INFINITY : middle.x / std::abs(dx);
    const double ty = dy == 0 ? INFINITY : middle.y / std::abs(dy);
    const double t = std::min(tx, ty);
    return {middle.x + t * dx, middle.y + t * dy};
}

Ray ray_at(const Camera& camera, const ImagePoint& pixel) {
    const auto ray = camera.refracted_ray(pixel.x, pixel.y);
    if (!ray) throw UsageError("no ray of the camera enters the water there");
    return *ray;
}

// The point of the ray at `distance` from `centre`, the farther one if there are two; NaN if there
// is none.
double farther_crossing(const Ray& ray, const Point3& centre, double distance) {
    const Vector3 to_origin = ray.origin - centre;
    const double b = glm::dot(to_origin, ray.direction);
    const double c = glm::dot(to_origin, to_origin) - distance * distance;
    return -b + std::sqrt(b * b - c);
}

Point3 in_water(const Ray& ray, double s) {
    if (!(s > 0)) throw UsageError("the lamp would be inside the camera's housing there");
    return ray.at(s);
}

double cross(const ImagePoint& o, const ImagePoint& a, const ImagePoint& b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

// Andrew's monotone chain (1979).
std::vector<ImagePoint> convex_hull(std::vector<ImagePoint> points) {
    if (points.size() < 3) return {};
    std::ranges::sort(points, [](const ImagePoint& a, const ImagePoint& b) {
        return a.x != b.x ? a.x < b.x : a.y < b.y;
    });
    std::vector<ImagePoint> hull;
    const auto add_chain = [&](auto begin, auto end) {
        const std::size_t base = hull.size();
        for (auto at = begin; at != end; ++at) {
            while (hull.size() >= base + 2 && cross(hull[hull.size() - 2], hull.back(), *at) <= 0)
                hull.pop_back();
            hull.push_back(*at);
        }
        hull.pop_back();
    };
    add_chain(points.begin(), points.end());
    add_chain(points.rbegin(), points.rend());
    return hull;
}

}  // namespace

ViewHandle view_handle(const Camera& camera, const Point3& world) {
    ViewHandle handle;
    handle.pixel = camera.project(world);
    if (!handle.pixel) {
        const Point3 local = camera.world_from_camera().inverse() * world;
        handle.rim = rim_point(camera, local.x, local.y);
        return handle;
    }
    const ImagePoint& at = *handle.pixel;
    handle.inside = at.x >= 0 && at.y >= 0 && at.x <= camera.width() && at.y <= camera.height();
    const ImagePoint middle = middle_of(camera);
    handle.rim = handle.inside ? at : rim_point(camera, at.x - middle.x, at.y - middle.y);
    return handle;
}

PlacedLamp placed_lamp(const LampDesc& lamp, const CameraDesc& camera) {
    const Affine& world_from_frame = lamp.world_from_frame(camera.world_from_camera);
    return {world_from_frame * lamp.position,
            glm::normalize(world_from_frame.apply_to_vector(lamp.direction))};
}

Point3 axis_point(const PlacedLamp& lamp) {
    return lamp.position + k_axis_length * lamp.direction;
}

std::optional<double> beam_half_angle(const LampProfileDesc& profile) {
    if (const auto* spot = std::get_if<SpotProfileDesc>(&profile)) return 0.5 * spot->beam;
    if (const auto* cosine = std::get_if<CosineProfileDesc>(&profile)) return 0.5 * cosine->fwhm;
    if (const auto* image = std::get_if<ImageProfileDesc>(&profile)) return 0.5 * image->fov;
    if (const auto* table = std::get_if<TableProfileDesc>(&profile)) {
        const double half = 0.5 * std::ranges::max(table->values);
        std::size_t i = table->values.size() - 1;
        while (table->values[i] < half) --i;  // the last of those, if the beam is hollow
        if (i + 1 == table->values.size()) return table->angles[i];
        const double fraction =
            (table->values[i] - half) / (table->values[i] - table->values[i + 1]);
        return table->angles[i] + fraction * (table->angles[i + 1] - table->angles[i]);
    }
    return std::nullopt;
}

std::vector<ImagePoint> beam_outline(const Camera& camera, const LampDesc& lamp,
                                     const PlacedLamp& placed) {
    const auto half_angle = beam_half_angle(lamp.profile);
    if (!half_angle) return {};
    const Vector3& axis = placed.direction;
    const Vector3 other = std::abs(axis.x) < 0.5 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
    const Vector3 right = glm::normalize(glm::cross(axis, other)), up = glm::cross(right, axis);
    const double along = std::cos(*half_angle * k_radians),
                 across = std::sin(*half_angle * k_radians);
    std::vector<ImagePoint> seen;
    if (const auto apex = camera.project(placed.position)) seen.push_back(*apex);
    for (int i = 0; i < k_circle_points; ++i) {
        const double turn = 2 * std::numbers::pi * i / k_circle_points;
        const Vector3 direction =
            along * axis + across * (std::cos(turn) * right + std::sin(turn) * up);
        if (const auto at = camera.project(placed.position + k_axis_length * direction))
            seen.push_back(*at);
    }
    return convex_hull(std::move(seen));
}

Point3 dragged_point(const Camera& camera, const ImagePoint& pixel, const Point3& from,
                     DragKeeps keeps) {
    const Ray ray = ray_at(camera, pixel);
    const Point3 centre = centre_of(camera);
    if (keeps == DragKeeps::distance)
        return in_water(ray, farther_crossing(ray, centre, distance(centre, from)));
    const Vector3 axis = camera.world_from_camera().apply_to_vector({0, 0, 1});
    const double slope = glm::dot(ray.direction, axis);
    return in_water(ray, glm::dot(from - ray.origin, axis) / slope);
}

Point3 point_at_distance(const Camera& camera, const Point3& from, double distance) {
    const Point3 centre = centre_of(camera);
    if (const auto pixel = camera.project(from)) {
        const Ray ray = ray_at(camera, *pixel);
        return in_water(ray, farther_crossing(ray, centre, distance));
    }
    const Vector3 offset = from - centre;
    if (!(distance > 0) || !(glm::length(offset) > 0))
        throw UsageError("give a distance above 0 m");
    return centre + distance / glm::length(offset) * offset;
}

Vector3 aimed_direction(const Camera& camera, const ImagePoint& pixel, const PlacedLamp& lamp) {
    const Ray ray = ray_at(camera, pixel);
    const Vector3 to_origin = ray.origin - lamp.position;
    const double b = glm::dot(to_origin, ray.direction);
    const double c = glm::dot(to_origin, to_origin) - k_axis_length * k_axis_length;
    const double root = std::sqrt(std::max(0.0, b * b - c));
    std::optional<Vector3> best;
    for (const double s : {-b - root, -b + root}) {
        const Vector3 towards = ray.at(std::max(0.0, s)) - lamp.position;
        if (!(glm::length(towards) > 0)) continue;
        const Vector3 direction = glm::normalize(towards);
        if (s > 0 &&
            (!best || glm::dot(direction, lamp.direction) > glm::dot(*best, lamp.direction)))
            best = direction;
    }
    if (!best) throw UsageError("the lamp's axis cannot be turned there");
    return *best;
}

std::vector<Point3> view_frustum(const Camera& camera) {
    std::vector<Point3> points;
    const double w = camera.width(), h = camera.height();
    for (const ImagePoint& corner : {ImagePoint{0, 0}, {w, 0}, {w, h}, {0, h}})
        if (const auto ray = camera.refracted_ray(corner.x, corner.y)) points.push_back(ray->at(1));
    return points;
}

}  // namespace uw
