#include "render/snow/snow_placing.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/parallel.h"
#include "render/snow/view_hull.h"

namespace uw {

namespace {

/// Cells of a class of particles in one layer of its lattice.
struct CellLayer {
    std::size_t kind;
    std::int64_t first;  // index along x
    double reach;
    const ViewHull* hull;
};

/// Two directions across a ray.
struct AcrossAxes {
    Vector3 u, v;

    explicit AcrossAxes(const Vector3& direction) {
        const Vector3 other = std::abs(direction.x) < 0.6 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
        u = glm::normalize(glm::cross(direction, other));
        v = glm::cross(direction, u);
    }
};

/// How far from `x` a ray passes the plane across `direction` through it.
Vector3 miss(const Ray& ray, const Point3& x, const Vector3& direction) {
    const double s = glm::dot(x - ray.origin, direction) / glm::dot(ray.direction, direction);
    return ray.at(s) - x;
}

/// Metres in that plane per pixel; empty where the image has no neighbouring rays.
std::optional<PlaneMap> plane_from_pixels(const Camera& camera, const ImagePoint& at,
                                          const Ray& ray, const Point3& x, const AcrossAxes& axes) {
    constexpr double k_step = 0.5;  // pixels
    const auto moved = [&](double dx, double dy) -> std::optional<std::array<double, 2>> {
        for (const double sign : {1.0, -1.0}) {
            const auto beside = camera.refracted_ray(at.x + sign * dx, at.y + sign * dy);
            if (!beside) continue;
            const Vector3 offset = sign / k_step * miss(*beside, x, ray.direction);
            return std::array<double, 2>{glm::dot(offset, axes.u), glm::dot(offset, axes.v)};
        }
        return std::nullopt;
    };
    const auto right = moved(k_step, 0), down = moved(0, k_step);
    if (!right || !down) return std::nullopt;
    const PlaneMap map{(*right)[0], (*right)[1], (*down)[0], (*down)[1]};
    if (!(std::abs(map.determinant()) > 0)) return std::nullopt;
    return map;
}

/// Where an image out of focus shows light of `x`, by the point of the aperture that it passes.
PlaneMap blur_of(const Camera& camera, const ImagePoint& at, const Ray& ray, const Point3& x,
                 const AcrossAxes& axes, const PlaneMap& pixels_from_plane) {
    if (!camera.has_aperture()) return {};
    PlaneMap misses;
    if (const auto side = camera.aperture_ray(at.x, at.y, {1, 0})) {
        const Vector3 offset = miss(*side, x, ray.direction);
        misses.xx = glm::dot(offset, axes.u);
        misses.yx = glm::dot(offset, axes.v);
    }
    if (const auto side = camera.aperture_ray(at.x, at.y, {0, 1})) {
        const Vector3 offset = miss(*side, x, ray.direction);
        misses.xy = glm::dot(offset, axes.u);
        misses.yy = glm::dot(offset, axes.v);
    }
    return pixels_from_plane * misses;
}

/// The path of the image of what is at `x` in the middle of the exposure.
Footprint::Path path_of(const std::vector<ExposureView>& views, const ImagePoint& at,
                        const Point3& x, const Vector3& drift, const AcrossAxes& axes,
                        const PlaneMap& pixels_from_plane) {
    // Shorter ones [pixels] are straight, and as long as their tangent.
    constexpr double k_short = 2;
    Footprint::Path path{{at.x, at.y}, {}, {}};
    // From the middle to the moments when the shutter opens and closes, in units of the half
    // exposure; an end that is unknown is taken to mirror the other.
    std::optional<std::array<double, 2>> before, after;
    for (std::size_t i = 1; i < views.size(); ++i) {
        // What the camera sees there at that moment it sees here in the middle.
        const Point3 there = views[i].middle_from_moment * (x + views[i].time * drift);
        const Vector3 moved = there - x;
        const double u = glm::dot(moved, axes.u), v = glm::dot(moved, axes.v);
        std::array<double, 2> step{pixels_from_plane.xx * u + pixels_from_plane.xy * v,
                                   pixels_from_plane.yx * u + pixels_from_plane.yy * v};
        if (std::hypot(step[0], step[1]) > k_short) {
            const auto image = views.front().camera.project(there);
            if (!image) continue;
            step = {image->x - at.x, image->y - at.y};
        }
        (views[i].time < 0 ? before : after) = step;
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double last = after ? (*after)[axis] : (before ? -(*before)[axis] : 0);
        const double first = before ? (*before)[axis] : -last;
        path.linear[axis] = 0.5 * (last - first);
        path.quadratic[axis] = 0.5 * (last + first);
    }
    return path;
}

/// Appends what the window shows of a particle.
void place(const SnowPlacing& scene, const SnowParticle& particle, double range,
           const PixelWindow& window, SnowSplats& result) {
    const Camera& camera = scene.views.front().camera;
    const Point3& x = particle.position;
    const auto sight = camera.sight(x);
    if (!sight) return;
    const ImagePoint& at = sight->image;
    const Ray& ray = sight->ray;
    const double distance = uw::distance(ray.origin, x);
    if (distance > range || distance <= 0.5 * particle.diameter) return;
    // Most that are not drawn are hidden, or else outside the window: first what tells the sooner.
    const bool is_within =
        at.x >= window.x0 && at.x < window.x1 && at.y >= window.y0 && at.y < window.y1;
    const auto end_of_sight = [&] {
        return scene.surfaces.empty() ? k_infinitely_far : scene.surfaces.hit_distance(ray);
    };
    double end = is_within ? end_of_sight() : k_infinitely_far;
    if (end <= distance) return;
    const AcrossAxes axes(ray.direction);
    const auto plane = plane_from_pixels(camera, at, ray, x, axes);
    if (!plane) return;
    const PlaneMap pixels = plane->inverse();
    const Footprint footprint(path_of(scene.views, at, x, scene.desc.drift, axes, pixels),
                              0.5 * particle.diameter * pixels,
                              blur_of(camera, at, ray, x, axes, pixels));
    const PixelWindow seen = intersection(footprint.bounds(), window);
    if (seen.width() <= 0 || seen.height() <= 0) return;
    if (!is_within) end = end_of_sight();
    if (end <= distance) return;
    const std::size_t bands = scene.desc.reflectance.size();
    thread_local std::vector<double> radiance;
    radiance.resize(bands);
    scene.lighting.radiance(x, ray, distance, radiance);
    // The coefficients hold the particles in front of this one, which cover it as well.
    const double seen_through =
        std::exp(scene.model.drawn_depth(distance)) * scene.sensor.surface_factor(distance);
    const auto first = static_cast<std::uint32_t>(result.radiance.size());
    for (std::size_t b = 0; b < bands; ++b)
        result.radiance.push_back(
            static_cast<float>(radiance[b] * scene.desc.reflectance[b] * seen_through));
    result.splats.push_back(
        {.distance = distance,
         .id = particle.id,
         .hidden = static_cast<float>(scene.veil.share_beyond(at.x, at.y, distance, end)),
         .radiance = first,
         .footprint = footprint});
}

std::int64_t cell_of(double position, double edge) {
    return static_cast<std::int64_t>(std::floor(position / edge));
}

/// The particles of a class in one layer of cells.
void place_layer(const SnowPlacing& scene, const CellLayer& layer, const PixelWindow& window,
                 SnowSplats& result) {
    const SnowClass& kind = scene.model.field.classes()[layer.kind];
    const Vector3 moved = scene.model.field.displacement(scene.time);
    const Bounds& bounds = layer.hull->bounds();
    const double margin = 0.5 * kind.greatest;
    const double around_cell = 0.5 * std::sqrt(3.0) * kind.edge + margin;
    std::array<std::int64_t, 2> first{}, last{};
    for (int axis = 1; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis - 1);
        first[i] = cell_of(bounds.min[axis] - margin - moved[axis], kind.edge);
        last[i] = cell_of(bounds.max[axis] + margin - moved[axis], kind.edge);
    }
    thread_local std::vector<SnowParticle> particles;
    for (std::int64_t j = first[0]; j <= last[0]; ++j)
        for (std::int64_t k = first[1]; k <= last[1]; ++k) {
            const SnowCell cell{layer.first, j, k};
            Point3 centre;
            for (int axis = 0; axis < 3; ++axis)
                centre[axis] =
                    (static_cast<double>(cell[static_cast<std::size_t>(axis)]) + 0.5) * kind.edge +
                    moved[axis];
            if (!layer.hull->may_see(centre, around_cell)) continue;
            particles.clear();
            scene.model.field.append_particles(layer.kind, cell, scene.time, particles);
            for (const SnowParticle& particle : particles)
                if (layer.hull->may_see(particle.position, margin))
                    place(scene, particle, layer.reach, window, result);
        }
}

}  // namespace

SnowSplats SnowPlacing::splats(const PixelWindow& window,
                               const std::function<void(double fraction)>& progress) const {
    std::vector<ViewHull> hulls;
    std::vector<CellLayer> layers;
    hulls.reserve(model.ranges.size());
    for (std::size_t k = 0; k < model.ranges.size(); ++k) {
        const SnowClass& kind = model.field.classes()[k];
        const ViewHull& hull = hulls.emplace_back(views, model.ranges[k], desc.drift);
        if (hull.bounds().empty()) continue;
        const double margin = 0.5 * kind.greatest + model.field.displacement(time).x;
        const double other = 0.5 * kind.greatest - model.field.displacement(time).x;
        const std::int64_t first = cell_of(hull.bounds().min.x - margin, kind.edge);
        const std::int64_t last = cell_of(hull.bounds().max.x + other, kind.edge);
        for (std::int64_t i = first; i <= last; ++i)
            layers.push_back({k, i, model.ranges[k], &hull});
    }
    std::vector<SnowSplats> parts(layers.size());
    std::atomic<std::size_t> done = 0;
    parallel_for(layers.size(), [&](std::size_t i) {
        place_layer(*this, layers[i], window, parts[i]);
        progress(static_cast<double>(++done) / static_cast<double>(layers.size()));
    });
    SnowSplats all;
    for (SnowSplats& part : parts) {
        all.append(part);
        part = {};
    }
    return all;
}

}  // namespace uw
