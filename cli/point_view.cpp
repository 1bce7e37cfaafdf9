#include "cli/point_view.h"

#include <algorithm>
#include <cmath>

namespace uw {

namespace {

constexpr int k_most_steps = 20;
constexpr double k_converged = 0.01;  // pixels

struct Step {
    double x = 0, y = 0;
};

/// Newton's step from the pixel (x, y); empty where there is no ray, or the point is behind it.
std::optional<Step> newton_step(const RaySource& camera, double x, double y, const Point3& point) {
    const auto middle = camera.water_ray(x, y);
    const auto right = camera.water_ray(x + 1, y), below = camera.water_ray(x, y + 1);
    if (!middle || !right || !below) return std::nullopt;
    const double s = glm::dot(point - middle->origin, middle->direction);
    if (!(s > 0)) return std::nullopt;
    const Point3 here = middle->at(s);
    const Vector3 error = point - here, u = right->at(s) - here, v = below->at(s) - here;
    const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return std::nullopt;
    const double eu = glm::dot(error, u), ev = glm::dot(error, v);
    return Step{(eu * vv - ev * uv) / determinant, (ev * uu - eu * uv) / determinant};
}

}  // namespace

std::optional<std::array<double, 2>> pixel_of(const RaySource& camera, const Point3& point) {
    const double width = camera.width(), height = camera.height();
    double x = 0.5 * width, y = 0.5 * height;
    for (int i = 0; i < k_most_steps; ++i) {
        const auto step = newton_step(camera, x, y, point);
        if (!step) return std::nullopt;
        // A step out of sight may lead where the camera has no rays.
        x = std::clamp(x + step->x, -0.5 * width, 1.5 * width);
        y = std::clamp(y + step->y, -0.5 * height, 1.5 * height);
        if (std::hypot(step->x, step->y) > k_converged) continue;
        if (x < 0 || x > width || y < 0 || y > height) return std::nullopt;
        return std::array{x, y};
    }
    return std::nullopt;
}

}  // namespace uw
