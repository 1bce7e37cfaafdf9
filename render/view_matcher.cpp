#include "render/view_matcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/geometry/gltf_reader.h"

namespace uw {

bool is_in_image(const ImagePoint& pixel, const Camera& camera) {
    return pixel.x >= 0 && pixel.y >= 0 && pixel.x <= camera.width() && pixel.y <= camera.height();
}

SeenPoint seen_point(const Point3& world, const Camera& camera, const Surfaces& surfaces) {
    if (std::isnan(world.x + world.y + world.z)) return {};
    const std::optional<ImagePoint> pixel = camera.project(world);
    if (!pixel) return {};
    const std::optional<Ray> ray = camera.refracted_ray(pixel->x, pixel->y);
    if (!ray) return {};
    SeenPoint point{*pixel, distance(ray->origin, world), is_in_image(*pixel, camera)};
    point.visible = point.in_image && !surfaces.occluded(ray->origin, world);
    return point;
}

std::optional<Point3> moved_point(const ObjectMotions& motions, const Surfaces& surfaces,
                                  const SurfaceHit& hit) {
    if (motions.empty()) return hit.position;
    const std::optional<ObjectMotion>& motion = motions.at(hit.object_id - 1);
    if (!motion) return std::nullopt;
    if (!motion->vertices) return motion->map * hit.position;
    const auto corners = surfaces.corners(hit);
    if (!corners) return std::nullopt;
    const std::array<double, 3> weights{1 - hit.u - hit.v, hit.u, hit.v};
    Vector3 sum(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = 3 * std::size_t{(*corners)[k]};
        if (at + 2 >= motion->vertices->size()) return std::nullopt;
        const float* p = &(*motion->vertices)[at];
        sum += weights[k] * Vector3(p[0], p[1], p[2]);
    }
    return Point3{sum.x, sum.y, sum.z};
}

ViewMatcher::ViewMatcher(Camera camera, std::shared_ptr<const Surfaces> own, ObjectMotions motions,
                         std::shared_ptr<const Surfaces> surfaces)
    : camera_(std::move(camera)),
      own_(std::move(own)),
      motions_(std::move(motions)),
      surfaces_(std::move(surfaces)) {}

void ViewMatcher::match(std::span<const SurfaceHit* const> hits,
                        std::span<std::optional<PointMatch>> matches) const {
    std::vector<Point3> from, to;
    std::vector<PointMatch*> within;
    std::vector<char> blocked;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        matches[i].reset();
        const std::optional<Point3> point = moved_point(motions_, *own_, *hits[i]);
        if (!point) continue;
        PointMatch& match = matches[i].emplace();
        const std::optional<Sighting> sighting = camera_.sight(*point);
        if (!sighting) continue;
        match.x = sighting->image.x;
        match.y = sighting->image.y;
        const bool is_outside =
            match.x < 0 || match.y < 0 || match.x >= camera_.width() || match.y >= camera_.height();
        if (!surfaces_ || is_outside) continue;
        from.push_back(sighting->ray.origin);
        to.push_back(*point);
        within.push_back(&match);
    }
    if (!surfaces_) return;
    blocked.resize(within.size());
    surfaces_->occluded_many(from, to, blocked);
    for (std::size_t i = 0; i < within.size(); ++i) within[i]->is_occluded = blocked[i] != 0;
}

namespace {

std::optional<Affine> inverse_of(const Affine& map) {
    const double determinant = map.determinant();
    if (determinant == 0 || !std::isfinite(determinant)) return std::nullopt;
    return map.inverse();
}

/// The vertices of a moment in world space, rounded as those that are traced.
std::shared_ptr<const std::vector<float>> placed(std::vector<float> vertices,
                                                 const Affine& world_from_object) {
    for (std::size_t at = 0; at + 2 < vertices.size(); at += 3) {
        float* p = &vertices[at];
        const Point3 world = world_from_object * Point3{p[0], p[1], p[2]};
        for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<float>(world[axis]);
    }
    return std::make_shared<const std::vector<float>>(std::move(vertices));
}

/// Returns the motions of the `count` objects of one entry of `geometry`.
ObjectMotions motions_of(const GeometryDesc& now, const GeometryDesc& then, std::size_t count,
                         std::vector<std::string>& warnings) {
    if (now.file != then.file) {
        warnings.push_back(fmt::format(
            "{}: no flow: its files are one for each frame, and do not say which points of one "
            "are which of the next; animate one glTF file instead",
            now.where));
        return ObjectMotions(count, std::nullopt);
    }
    const Affine object_from_world = now.world_from_object.inverse();
    if (!now.animation)
        return ObjectMotions(count, ObjectMotion{now.world_from_object == then.world_from_object
                                                     ? Affine()
                                                     : then.world_from_object * object_from_world,
                                                 nullptr});
    GltfSource source(now.file, {});
    const std::vector<Affine> before = source.placements(now.time.value_or(0));
    GltfMoment after = source.moment(then.time.value_or(0));
    const auto vertices = placed(std::move(after.vertices), then.world_from_object);
    ObjectMotions motions(count);
    for (std::size_t i = 0; i < std::min(count, before.size()); ++i) {
        if (after.deforms[i]) {
            motions[i] = ObjectMotion{{}, vertices};
            continue;
        }
        // A node that is scaled to zero has no points.
        if (const auto node_from_file = inverse_of(before[i]))
            motions[i] = ObjectMotion{then.world_from_object * after.file_from_object[i] *
                                          *node_from_file * object_from_world,
                                      nullptr};
    }
    return motions;
}

}  // namespace

ObjectMotions object_motions(const SceneDesc& now, const SceneDesc& then, const SurfaceNames& names,
                             std::vector<std::string>& warnings) {
    if (now.geometry == then.geometry) return {};
    std::vector<std::size_t> counts(now.geometry.size(), 0);
    for (const SurfaceName& object : names.objects)
        if (object.entry) ++counts.at(*object.entry);
    ObjectMotions motions;
    for (std::size_t entry = 0; entry < now.geometry.size(); ++entry) {
        const ObjectMotions own =
            motions_of(now.geometry[entry], then.geometry[entry], counts[entry], warnings);
        motions.insert(motions.end(), own.begin(), own.end());
    }
    return motions;
}

}  // namespace uw
