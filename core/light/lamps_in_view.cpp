#include "core/light/lamps_in_view.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace uw {

namespace {

// A lamp may be that far behind the surface to which it is fixed [m].
constexpr double k_contact = 1e-4;
// A flat surface that is seen from within this sine is a line. A profile that does not fall like
// the cosine makes it brighter without bound there.
constexpr double k_edge_on = 1e-3;
// Farther from a point than so many radii of its patch, its light on a ray is its own.
constexpr double k_patches_aside = 3;

// The mean over the points of the integral of 1/R^2 along a stretch of a ray [1/m].
double integrated_light(const LampPoints& points, const Ray& ray, const Interval& stretch) {
    double sum = 0;
    for (const Point3& position : points.positions) {
        const Vector3 to_point = position - ray.origin;
        const double foot = glm::dot(to_point, ray.direction);
        const Vector3 across = to_point - foot * ray.direction;
        const double distance = std::sqrt(glm::dot(across, across) +
                                          distance_aside(position, points.patch_radius, ray));
        sum += (std::atan((stretch.end - foot) / distance) -
                std::atan((stretch.begin - foot) / distance)) /
               distance;
    }
    return sum / static_cast<double>(points.positions.size());
}

}  // namespace

double LampSurface::area() const {
    if (extent.shape == LampExtentDesc::Shape::disk)
        return std::numbers::pi * extent.radius * extent.radius;
    return extent.width * extent.height;
}

double LampSurface::evenness(const Ray& ray, const Interval& stretch) const {
    const Vector3 across = glm::cross(lamp.position() - ray.origin, ray.direction);
    const double half = extent.shape == LampExtentDesc::Shape::disk
                            ? extent.radius
                            : 0.5 * std::hypot(extent.width, extent.height);
    const double near = half + k_patches_aside * emitters.patch_radius;
    if (glm::dot(across, across) > near * near) return 1;
    const double of_emitters = integrated_light(emitters, ray, stretch);
    return of_emitters > 0 ? integrated_light(many, ray, stretch) / of_emitters : 1;
}

double evenness(const LitScene& scene, std::size_t lamp, const Ray& ray, const Interval& stretch) {
    if (scene.lamp_surfaces)
        for (const LampSurface& surface : *scene.lamp_surfaces)
            if (surface.lamp.index() == lamp) return surface.evenness(ray, stretch);
    return 1;
}

void find_evenness(const LitScene& scene, std::size_t lamp, const Ray& ray, double begin,
                   std::span<const double> distances, std::vector<double>& result) {
    result.clear();
    for (const double distance : distances) {
        result.push_back(evenness(scene, lamp, ray, {begin, distance}));
        begin = distance;
    }
}

double LampSurface::crossing(const Ray& ray) const {
    constexpr double k_nowhere = std::numeric_limits<double>::infinity();
    const Vector3 normal = glm::cross(x, y);
    const double towards = glm::dot(normal, ray.direction);
    if (towards == 0) return k_nowhere;
    const double s = glm::dot(normal, lamp.position() - ray.origin) / towards;
    if (!(s > 0)) return k_nowhere;
    const Vector3 from_center = ray.at(s) - lamp.position();
    const double across = glm::dot(from_center, x), along = glm::dot(from_center, y);
    const bool is_inside =
        extent.shape == LampExtentDesc::Shape::disk
            ? across * across + along * along <= extent.radius * extent.radius
            : std::abs(across) <= 0.5 * extent.width && std::abs(along) <= 0.5 * extent.height;
    return is_inside ? s : k_nowhere;
}

double LampSurface::radiance_towards(const Ray& ray) const {
    const double cosine = std::abs(glm::dot(glm::cross(x, y), ray.direction));
    if (cosine < k_edge_on) return 0;
    return lamp.relative_intensity(-ray.direction) / (area() * cosine);
}

void LampsInView::append(const Ray& ray, double reach, std::vector<SeenLamp>& seen) const {
    if (!scene_.lamp_surfaces) return;
    for (const LampSurface& surface : *scene_.lamp_surfaces) {
        const double distance = surface.crossing(ray);
        if (!(distance < reach + k_contact && distance < k_far)) continue;
        const double radiance = surface.radiance_towards(ray);
        if (radiance == 0) continue;
        thread_local std::vector<double> column;
        column.assign(scene_.medium->constituents.size(), 0.0);
        if (!column.empty()) scene_.field->column(ray.origin, ray.at(distance), column);
        SeenLamp& lamp = seen.emplace_back();
        lamp.lamp = surface.lamp.index();
        lamp.distance = distance;
        lamp.radiance = radiance * surface.lamp.axis_intensity();
        lamp.arriving = weight_.of(distance, column) *
                        (attenuation_.transmittance(distance, column) * lamp.radiance);
    }
}

}  // namespace uw
