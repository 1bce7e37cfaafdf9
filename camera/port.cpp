#include "camera/port.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include "core/base/refraction.h"

namespace uw {

namespace {

/// The cosines to a port's normals at which a ray meets its surfaces.
struct PortCosines {
    double inner_air = 1;    // in air, at the inner surface
    double outer_glass = 1;  // in glass, at the outer surface
};

/// Port::transmittance for a ray that meets the surfaces at these angles. Both surfaces share their
/// plane of incidence, so each polarisation is transmitted by itself.
template <class PortDescription>
double port_transmittance(const PortDescription& port, const PortCosines& cosines) {
    double result = 1;
    if (port.radiance_in_air) {
        const double ratio = port.n_air / port.n_water;
        result *= ratio * ratio;
    }
    if (port.fresnel) {
        const FresnelTransmittance inner =
            fresnel_transmittance(cosines.inner_air, port.n_air, port.n_glass);
        const FresnelTransmittance outer =
            fresnel_transmittance(cosines.outer_glass, port.n_glass, port.n_water);
        result *= 0.5 * (inner.s * outer.s + inner.p * outer.p);
    }
    return result;
}

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
struct LateralOffset {
    double distance = 0, slope = 0;
};
LateralOffset lateral_offset(const std::array<Layer, 3>& layers, double n, double u) {
    LateralOffset sum;
    for (const Layer& layer : layers) {
        const double more = layer.index * layer.index - n * n;  // >= 0
        const double root = std::sqrt(layer.index * layer.index + more * u * u);
        sum.distance += layer.depth * n * u / root;
        sum.slope += layer.depth * n * (layer.index / root) * (layer.index / root) / root;
    }
    return sum;
}

/// An initial slope for a ray through the water and thin layers before it: the exact one for the
/// water alone with its part of the distance. `least`: the slope if the distance were proportional
/// to it.
double first_slope(const Layer& water, double n, double least) {
    const double across = least * n / water.index;  // per depth of water
    const double more = water.index * water.index - n * n;
    const double rest = n * n - across * across * more;
    return rest > 0 ? std::max(least, water.index * across / std::sqrt(rest)) : least;
}

class FlatPort final : public Port {
  public:
    explicit FlatPort(const FlatPortDesc& desc) : desc_(desc) {}

    std::optional<Ray> refracted_ray(const Point3& from, const Vector3& direction) const override;
    double transmittance(const Vector3& direction) const override;
    std::optional<Vector3> direction_to(const Point3& point) const override;

  private:
    FlatPortDesc desc_;
};

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

// Refraction stays in the plane of the normal and the point, where the ray's distance from the
// normal at the point's depth increases with its slope: one monotone equation (Agrawal et al.
// 2012), solved to the last digits.
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
    const double least = wanted / lateral_offset(layers, n, 0).slope;
    double u = first_slope(layers.back(), n, least);
    for (int iteration = 0;; ++iteration) {
        const LateralOffset here = lateral_offset(layers, n, u);
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

constexpr int k_dome_max_iterations = 200;
/// Newton's last step [rad]; convergence is quadratic, so no error remains.
constexpr double k_dome_tolerance = 1e-13;
/// The origin of a water ray may be rounded into the glass by this fraction of its radius.
constexpr double k_dome_rounding = 1e-12;

/// Distance along a ray from `origin` (from the sphere's centre, inside) to the sphere.
double leave_sphere(const Vector3& origin, const Vector3& direction, double radius) {
    const double along = glm::dot(origin, direction);
    // radius^2 - origin^2 as a product: precise for a camera close to the glass.
    const double length = glm::length(origin);
    const double inside = (radius - length) * (radius + length);
    const double root = std::sqrt(along * along + inside);
    // The larger root of t^2 + 2 along t - inside, without cancellation.
    return along > 0 ? inside / (along + root) : root - along;
}

/// The angle to the radius at radius * index = `a` of the ray with Bouguer's invariant `h`, with
/// its derivative with respect to h; where h > a the ray does not get there, and the angle stays at
/// 90 degrees.
struct Angle {
    double value, slope;
};
Angle angle_at(double h, double a) {
    const double sine = h / a;
    if (!(sine < 1)) return {std::numbers::pi / 2, 0};
    return {std::asin(sine), 1 / (a * std::sqrt((1 - sine) * (1 + sine)))};
}

class DomePort final : public Port {
  public:
    explicit DomePort(const DomePortDesc& desc) : desc_(desc) {}

    std::optional<Ray> refracted_ray(const Point3& from, const Vector3& direction) const override;
    double transmittance(const Vector3& direction) const override;
    std::optional<Vector3> direction_to(const Point3& point) const override;

  private:
    /// The path through the glass: where a ray leaves it, and its direction in the water.
    struct Passage {
        Vector3 outer;  // from the spheres' centre
        Vector3 in_water{0, 0, 1};
        PortCosines cosines;
    };
    std::optional<Passage> passage(const Point3& from, const Vector3& direction) const;

    DomePortDesc desc_;
};

std::optional<DomePort::Passage> DomePort::passage(const Point3& from,
                                                   const Vector3& direction) const {
    const Vector3 camera = from - desc_.center;
    const Vector3 inner = camera + leave_sphere(camera, direction, desc_.radius) * direction;
    const Vector3 inner_normal = glm::normalize(inner);
    const auto in_glass = refract(direction, inner_normal, desc_.n_air, desc_.n_glass);
    if (!in_glass) return std::nullopt;
    const double outer_radius = desc_.radius + desc_.thickness;
    const double through = desc_.thickness > 0 ? leave_sphere(inner, *in_glass, outer_radius) : 0;
    Passage result;
    result.outer = inner + through * *in_glass;
    const Vector3 outer_normal = glm::normalize(result.outer);
    const auto in_water = refract(*in_glass, outer_normal, desc_.n_glass, desc_.n_water);
    if (!in_water) return std::nullopt;
    result.in_water = *in_water;
    result.cosines = {glm::dot(direction, inner_normal), glm::dot(*in_glass, outer_normal)};
    return result;
}

std::optional<Ray> DomePort::refracted_ray(const Point3& from, const Vector3& direction) const {
    const auto path = passage(from, direction);
    if (!path) return std::nullopt;
    return Ray{desc_.center + path->outer, path->in_water};
}

double DomePort::transmittance(const Vector3& direction) const {
    const auto path = passage(Point3{}, direction);
    if (!path) return 0;
    return port_transmittance(desc_, path->cosines);
}

// A ray stays in the plane of the spheres' centre, the camera and the point, and n r sin(i), with i
// its angle to the radius r, is constant along it (Bouguer's law): one equation for the angle that
// the ray sweeps around the centre, solved to the last digits.
std::optional<Vector3> DomePort::direction_to(const Point3& point) const {
    const Vector3 camera = -from_origin(desc_.center);
    const Vector3 target = point - desc_.center;
    const double offset = glm::length(camera), radius = glm::length(target);
    const double inner = desc_.radius, outer = desc_.radius + desc_.thickness;
    if (!std::isfinite(radius) || radius < (1 - k_dome_rounding) * outer) return std::nullopt;
    if (offset == 0) return target / radius;

    // In the plane of centre, camera and point, `u` points towards the camera.
    const Vector3 u = camera / offset;
    const double along = glm::dot(target, u);
    const Vector3 across = target - along * u;
    const double beside = glm::length(across);
    const double swept = std::atan2(beside, along);
    if (beside == 0) return along > 0 ? u : -u;

    // The angle that a ray sweeps increases with its own angle `a` to u, from 0 to pi, if the
    // indices increase from air to water and glass; a bracket keeps Newton's method safe if they do
    // not.
    double low = 0, high = std::numbers::pi, a = swept;
    bool passes = false;
    for (int iteration = 0; iteration < k_dome_max_iterations; ++iteration) {
        const double h = desc_.n_air * offset * std::sin(a);
        const Angle at_inner = angle_at(h, desc_.n_air * inner);
        const Angle into_glass = angle_at(h, desc_.n_glass * inner);
        const Angle at_outer = angle_at(h, desc_.n_glass * outer);
        const Angle into_water = angle_at(h, desc_.n_water * outer);
        const Angle at_point = angle_at(h, desc_.n_water * radius);
        passes = h < desc_.n_glass * inner && h < desc_.n_water * outer;
        const double excess = (a - swept) + (into_water.value - at_point.value) -
                              (at_inner.value - into_glass.value) - at_outer.value;
        const double slope = 1 + desc_.n_air * offset * std::cos(a) *
                                     (into_water.slope - at_point.slope - at_inner.slope +
                                      into_glass.slope - at_outer.slope);
        (excess > 0 ? high : low) = a;
        double next = a - excess / slope;
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const double step = std::abs(next - a);
        a = next;
        if (step <= k_dome_tolerance) break;
    }
    if (!passes) return std::nullopt;
    return std::cos(a) * u + (std::sin(a) / beside) * across;
}

}  // namespace

std::shared_ptr<const Port> make_port(const PortDesc& desc) {
    if (const auto* dome = std::get_if<DomePortDesc>(&desc))
        return std::make_shared<DomePort>(*dome);
    return std::make_shared<FlatPort>(std::get<FlatPortDesc>(desc));
}

}  // namespace uw
