#include "render/snow/view_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace uw {

namespace {

// Rays along each edge of the image and in rows between. What bulges between two of them, of the
// edges of a distorted image, is less than (angle between them)^2 / 8 of the distance.
constexpr int k_steps = 48;
constexpr double k_bulge = 1e-3;

/// The rays of an image position through the centre of the aperture and around its rim.
void append_rays(const Camera& camera, double x, double y, std::vector<Ray>& rays) {
    if (const auto ray = camera.refracted_ray(x, y)) rays.push_back(*ray);
    if (!camera.has_aperture()) return;
    // An octagon around the circle.
    constexpr double k_around = 1.0824;  // 1 / cos 22.5 degrees
    for (int i = 0; i < 8; ++i) {
        const double angle = i * 0.7853981633974483;
        const auto ray =
            camera.aperture_ray(x, y, {k_around * std::cos(angle), k_around * std::sin(angle)});
        if (ray) rays.push_back(*ray);
    }
}

/// Outward normals of a pyramid through the corners of the view; wherever they point, the body
/// between planes across them holds all that is seen.
std::vector<Vector3> side_normals(const Camera& camera) {
    const double width = camera.width(), height = camera.height();
    const std::array<std::optional<Ray>, 4> corners{
        camera.refracted_ray(0, 0), camera.refracted_ray(width, 0),
        camera.refracted_ray(width, height), camera.refracted_ray(0, height)};
    const auto axis = camera.refracted_ray(0.5 * width, 0.5 * height);
    std::vector<Vector3> normals;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
        if (!a || !b || !axis) continue;
        const Vector3 across = glm::cross(a->direction, b->direction);
        if (glm::length(across) < 1e-9) continue;
        const double side = glm::dot(across, axis->direction) > 0 ? -1 : 1;
        normals.push_back(side / glm::length(across) * across);
    }
    if (axis) normals.push_back(axis->direction);
    return normals;
}

}  // namespace

ViewHull::ViewHull(const std::vector<ExposureView>& views, double reach, const Vector3& drift) {
    for (const Vector3& normal : side_normals(views.front().camera))
        planes_.push_back({normal, -1e300});
    std::vector<Ray> rays;
    for (const ExposureView& view : views) {
        rays.clear();
        for (int j = 0; j <= k_steps; ++j)
            for (int i = 0; i <= k_steps; ++i) {
                const bool is_edge = i == 0 || j == 0 || i == k_steps || j == k_steps;
                if (!is_edge && (i % 8 != 0 || j % 8 != 0)) continue;
                append_rays(view.camera, static_cast<double>(i) / k_steps * view.camera.width(),
                            static_cast<double>(j) / k_steps * view.camera.height(), rays);
            }
        for (const Ray& ray : rays)
            for (const double s : {0.0, reach}) {
                const Point3 seen = ray.at(s) - view.time * drift;
                bounds_.extend(seen);
                for (Plane& plane : planes_)
                    plane.offset =
                        std::max(plane.offset, glm::dot(plane.normal, from_origin(seen)));
            }
    }
    if (bounds_.empty()) return;
    const double margin = k_bulge * reach;
    for (int axis = 0; axis < 3; ++axis) {
        bounds_.min[axis] -= margin;
        bounds_.max[axis] += margin;
    }
    for (Plane& plane : planes_) plane.offset += margin;
}

}  // namespace uw
