#include "camera/port/flat_port.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "camera/port/refract.h"

namespace uw {
namespace {

constexpr int k_flat_max_iterations = 200;
/// Newton's last step, relative. It leaves no error: of each layer's distance |u f''| <= 3 f', so
/// that the next step would be 1.5 times its square.
constexpr double k_flat_tolerance = 1e-8;
/// The origin of a water ray may be rounded into the glass by this fraction of its depth.
constexpr double k_flat_rounding = 1e-12;

/// One medium on the path, in the plane of refraction.
struct Layer {
    double depth;  // along the normal [m]
    double index;
};

/// Distance from the normal covered by a ray of slope `u` (tangent of its angle to the normal) in
/// the medium of the lowest index `n`, and its derivative. With Snell's invariant s = n u / sqrt(1
/// + u^2) a layer covers depth * s / sqrt(index^2 - s^2), here written without cancellation.
struct Reach {
    double distance = 0, slope = 0;
};
Reach reach(const std::array<Layer, 3>& layers, double n, double u) {
    Reach sum;
    for (const Layer& layer : layers) {
        const double more = layer.index * layer.index - n * n;  // >= 0
        const double root = std::sqrt(layer.index * layer.index + more * u * u);
        sum.distance += layer.depth * n * u / root;
        sum.slope += layer.depth * n * (layer.index / root) * (layer.index / root) / root;
    }
    return sum;
}

/// A slope close to that of a ray through the water and thin layers before it, whose slope would be
/// `least` if the distance were proportional to it: the water alone, with its share of that
/// distance.
double first_slope(const Layer& water, double n, double least) {
    const double across = least * n / water.index;  // per depth of water
    const double more = water.index * water.index - n * n;
    const double rest = n * n - across * across * more;
    return rest > 0 ? std::max(least, water.index * across / std::sqrt(rest)) : least;
}

}  // namespace

std::optional<Ray> FlatPort::refracted_ray(const Point3& from, const Vector3& direction) const {
    const Vector3& n = desc_.normal;
    const double cos_air = glm::dot(direction, n);
    if (!(cos_air > 0)) return std::nullopt;
    const auto in_glass = refract(direction, n, desc_.n_air, desc_.n_glass);
    if (!in_glass) return std::nullopt;
    const auto in_water = refract(*in_glass, n, desc_.n_glass, desc_.n_water);
    if (!in_water) return std::nullopt;

    const double ahead = desc_.distance - glm::dot(from_origin(from), n);
    const Vector3 inner = from_origin(from) + (ahead / cos_air) * direction;
    const Vector3 outer = inner + (desc_.thickness / glm::dot(*in_glass, n)) * *in_glass;
    const double reached = glm::dot(outer, outer);
    if (!std::isfinite(reached)) return std::nullopt;
    return Ray{at_origin_plus(outer), *in_water};
}

double FlatPort::transmittance(const Vector3& direction) const {
    const Vector3& n = desc_.normal;
    const auto in_glass = refract(direction, n, desc_.n_air, desc_.n_glass);
    if (!in_glass) return 0;
    return port_transmittance(desc_, {glm::dot(direction, n), glm::dot(*in_glass, n)});
}

std::optional<Vector3> FlatPort::direction_to(const Point3& point) const {
    const Vector3& normal = desc_.normal;
    const Vector3 to_point = from_origin(point);
    const double depth = glm::dot(to_point, normal);
    double water = depth - desc_.distance - desc_.thickness;
    if (!(water >= -k_flat_rounding * depth) || !(depth > 0)) return std::nullopt;
    water = std::max(water, 0.0);
    const Vector3 across = to_point - depth * normal;
    const double wanted = glm::length(across);
    if (!std::isfinite(wanted)) return std::nullopt;
    if (wanted == 0) return normal;

    const std::array<Layer, 3> layers{
        {{desc_.distance, desc_.n_air}, {desc_.thickness, desc_.n_glass}, {water, desc_.n_water}}};
    const double n = std::min({desc_.n_air, desc_.n_glass, desc_.n_water});
    // The distance is a concave function of the slope, so that a step of Newton's method ends below
    // the root wherever it begins, and no later step overshoots: one backwards is rounding. If the
    // distance cannot be reached (no depth in the medium of the lowest index) it diverges.
    const double least = wanted / reach(layers, n, 0).slope;
    double u = first_slope(layers.back(), n, least);
    for (int iteration = 0;; ++iteration) {
        const Reach here = reach(layers, n, u);
        const double next = std::max(u + (wanted - here.distance) / here.slope, least);
        if (iteration == k_flat_max_iterations || !std::isfinite(next)) return std::nullopt;
        const double step = iteration == 0 ? std::abs(next - u) : next - u;
        u = next;
        if (step <= k_flat_tolerance * u) break;
    }
    const double sine = n / desc_.n_air * u / std::sqrt(1 + u * u);
    const double cos_squared = desc_.n_air == n ? 1 / (1 + u * u) : 1 - sine * sine;
    if (!(cos_squared > 0)) return std::nullopt;
    return glm::normalize(std::sqrt(cos_squared) * normal + (sine / wanted) * across);
}

}  // namespace uw
