#include "core/geometry/embree_surfaces.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/geometry/embree_scene.h"
#include "core/geometry/textured_surfaces.h"

namespace uw {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
/// How often a closest hit at or behind the origin is skipped, as for a camera in a surface's
/// plane.
constexpr int k_max_restarts = 16;
/// SurfaceHit::geometry of hits that are not on a mesh.
constexpr std::uint32_t k_no_mesh = std::numeric_limits<std::uint32_t>::max();

class EmbreeSurfaces final : public Surfaces, public TexturedSurfaces {
  public:
    explicit EmbreeSurfaces(SceneObjects objects)
        : objects_(std::move(objects)), scene_(objects_), traced_(scene_.traced()) {
        const auto has_some = [](const auto& mesh) { return mesh->has_textures; };
        has_textures_ = std::ranges::any_of(objects_.meshes, has_some) ||
                        std::ranges::any_of(objects_.shared_meshes, has_some);
    }

    bool closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const override {
        return shade(find_nearest(ray, s_end), ray, s_end, hit);
    }

    SurfaceMaterial material(const SurfaceHit& hit) const override {
        if (!hit.has_material) return {};
        return material_of_mesh(objects_.placed(hit.geometry), objects_.bands, hit);
    }

    std::optional<std::array<std::uint32_t, 3>> corners(const SurfaceHit& hit) const override {
        if (hit.geometry >= objects_.meshes.size()) return std::nullopt;
        const std::uint32_t* first =
            &objects_.meshes[hit.geometry]->mesh.triangles[3 * std::size_t{hit.triangle}];
        return std::array{first[0], first[1], first[2]};
    }

    bool may_emit() const override {
        const auto emits = [](const MeshObject& object) {
            return std::ranges::any_of(object.mesh.materials, [](const MeshMaterial& material) {
                return material.emission != Rgb{0, 0, 0};
            });
        };
        return std::ranges::any_of(objects_.meshes,
                                   [&](const auto& object) { return emits(*object); }) ||
               std::ranges::any_of(objects_.instances,
                                   [&](const auto& instance) { return emits(*instance.object); });
    }

    bool has_textures() const override { return has_textures_; }

    bool is_textured(const SurfaceHit& hit) const override {
        return hit.geometry < objects_.placed_count() &&
               is_textured_mesh(objects_.placed(hit.geometry), hit.triangle);
    }

    void filter_textures(const SurfaceSpread& spread, SurfaceHit& hit) const override {
        if (hit.geometry < objects_.placed_count())
            filter_mesh(objects_.placed(hit.geometry), objects_.bands, spread, hit);
    }

    void add_to_texture(const SurfaceHit& hit, std::span<const double> by_reflectance,
                        TextureGradient& gradient) const override {
        if (hit.geometry < objects_.placed_count())
            add_to_texture_of_mesh(objects_.placed(hit.geometry), objects_.bands, hit,
                                   by_reflectance, gradient);
    }

    double hit_distance(const Ray& ray) const override {
        return find_nearest(ray, k_infinity).distance;
    }

    bool occluded(const Point3& from, const Point3& to) const override {
        Query query = shadow_query(from, to);
        if (query.direction == Vector3(0.0)) return false;
        return blocked_by_plane(query) || is_occluded(traced_, query);
    }

    void closest_hits(std::span<const Ray> rays, double s_end, std::span<SurfaceHit> hits,
                      std::span<char> found) const override {
        assert(hits.size() == rays.size() && found.size() == rays.size());
        std::array<Candidate, k_packet_size> nearest;
        for (std::size_t begin = 0; begin < rays.size(); begin += k_packet_size) {
            const auto packet = rays.subspan(begin, std::min(k_packet_size, rays.size() - begin));
            find_nearest(packet, s_end, nearest);
            for (std::size_t i = 0; i < packet.size(); ++i) {
                found[begin + i] = shade(nearest[i], packet[i], s_end, hits[begin + i]) ? 1 : 0;
            }
        }
    }

    void hit_distances(const Point3& origin, std::span<const Vector3> directions,
                       std::span<double> distances) const override {
        assert(distances.size() == directions.size());
        std::array<Ray, k_packet_size> rays;
        std::array<Candidate, k_packet_size> nearest;
        for (std::size_t begin = 0; begin < directions.size(); begin += k_packet_size) {
            const std::size_t count = std::min(k_packet_size, directions.size() - begin);
            for (std::size_t i = 0; i < count; ++i) rays[i] = {origin, directions[begin + i]};
            find_nearest(std::span(rays).first(count), k_infinity, nearest);
            for (std::size_t i = 0; i < count; ++i) distances[begin + i] = nearest[i].distance;
        }
    }

    void occluded_many(const Point3& from, std::span<const Point3> to,
                       std::span<char> blocked) const override {
        assert(blocked.size() == to.size());
        find_blocked(blocked, [&](std::size_t i) { return shadow_query(from, to[i]); });
    }

    void occluded_many(std::span<const Point3> from, std::span<const Point3> to,
                       std::span<char> blocked) const override {
        assert(from.size() == to.size() && blocked.size() == to.size());
        find_blocked(blocked, [&](std::size_t i) { return shadow_query(from[i], to[i]); });
    }

    const SurfaceNames& names() const override { return objects_.names; }

    Bounds bounds() const override { return objects_.bounds; }

    std::uint64_t triangle_count() const override {
        std::uint64_t count = 0;
        for (const auto& object : objects_.meshes) count += object->mesh.triangle_count();
        for (const auto& instance : objects_.instances)
            count += instance.object->mesh.triangle_count();
        return count;
    }

    bool empty() const override {
        return objects_.placed_count() == 0 && objects_.spheres.empty() && objects_.planes.empty();
    }

  private:
    struct Candidate {
        double distance = k_infinity;
        const PlaneObject* plane = nullptr;  // if set, the rest is unused
        unsigned geometry = 0, primitive = 0;
        TriangleCrossing crossing;  // of meshes
        bool near_edge = false;     // of a triangle, where rounding decides (embree_rays.h)
    };

    /// Fills `hit` unless `nearest` is empty or beyond `s_end`.
    bool shade(const Candidate& nearest, const Ray& ray, double s_end, SurfaceHit& hit) const {
        if (!(nearest.distance <= s_end) || nearest.distance == k_infinity) return false;
        hit.distance = nearest.distance;
        hit.position = ray.at(nearest.distance);
        hit.spread = {};
        if (nearest.plane != nullptr) {
            shade_plane(*nearest.plane, ray.direction, hit);
            hit.geometry = k_no_mesh;
        } else if (nearest.geometry < objects_.placed_count()) {
            shade_mesh(objects_.placed(nearest.geometry), nearest.primitive, nearest.crossing,
                       objects_.bands, ray.direction, hit);
            hit.geometry = nearest.geometry;
        } else {
            shade_sphere(objects_.spheres[nearest.primitive], ray.direction, hit);
            hit.geometry = k_no_mesh;
        }
        return true;
    }

    /// The nearest mesh or sphere, not necessarily within `s_end`.
    Candidate trace_past_origin(const Ray& ray, double s_end) const {
        float begin = 0;
        for (int restart = 0; restart < k_max_restarts; ++restart) {
            Query query{ray.origin, ray.direction};
            trace(traced_, query, begin, s_end);
            if (!query.has_candidate()) break;
            Candidate candidate = refine(query);
            if (candidate.near_edge) {
                query = {ray.origin, ray.direction};
                trace_edges(traced_, query, begin, s_end);
                if (!query.has_candidate()) break;
                candidate = refine(query);
            }
            if (candidate.distance > 0) return candidate;
            begin = std::nextafter(query.t, std::numeric_limits<float>::infinity());
        }
        return {};
    }

    /// Embree's candidate, recomputed in double precision.
    Candidate refine(const Query& query) const {
        Candidate candidate;
        candidate.geometry = query.geometry;
        candidate.primitive = query.primitive;
        const double coarse = query.t;
        if (candidate.geometry < objects_.placed_count()) {
            const auto crossing =
                cross_triangle(objects_.placed(candidate.geometry), candidate.primitive,
                               query.origin, query.direction);
            candidate.crossing = crossing ? *crossing : TriangleCrossing{coarse, query.u, query.v};
            candidate.distance = candidate.crossing.t;
            candidate.near_edge = !(crossing && crossing->well_inside());
            return candidate;
        }
        const auto roots =
            cross_sphere(objects_.spheres[candidate.primitive], query.origin, query.direction);
        // The callback computed these roots; the one it chose is the closer to the value it wrote.
        const bool near = std::abs(roots->near - coarse) <= std::abs(roots->far - coarse);
        candidate.distance = near ? roots->near : roots->far;
        return candidate;
    }

    Candidate nearest_plane(const Ray& ray) const {
        Candidate nearest;
        for (const PlaneObject& plane : objects_.planes) {
            const auto t = cross_plane(plane, ray.origin, ray.direction);
            if (!t || !(*t > 0) || *t >= nearest.distance) continue;
            nearest.distance = *t;
            nearest.plane = &plane;
        }
        return nearest;
    }

    Candidate find_nearest(const Ray& ray, double s_end) const {
        const Candidate plane = nearest_plane(ray);
        const Candidate traced = trace_past_origin(ray, std::min(s_end, plane.distance));
        return traced.distance < plane.distance ? traced : plane;
    }

    /// The same for up to a packet of rays.
    void find_nearest(std::span<const Ray> rays, double s_end,
                      std::array<Candidate, k_packet_size>& nearest) const {
        std::array<Query, k_packet_size> queries;
        std::array<double, k_packet_size> ends{};
        for (std::size_t i = 0; i < rays.size(); ++i) {
            nearest[i] = nearest_plane(rays[i]);
            queries[i] = {rays[i].origin, rays[i].direction};
            ends[i] = std::min(s_end, nearest[i].distance);
        }
        trace_packet(traced_, std::span(queries).first(rays.size()),
                     std::span(ends).first(rays.size()));
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (!queries[i].has_candidate()) continue;
            Candidate traced = refine(queries[i]);
            if (traced.near_edge || !(traced.distance > 0)) {
                traced = trace_past_origin(rays[i], ends[i]);
            }
            if (traced.distance < nearest[i].distance) nearest[i] = traced;
        }
    }

    static Query shadow_query(const Point3& from, const Point3& to) {
        // A fixed order of the ends for both directions, so that light and view rays agree exactly.
        const bool forward = std::tie(from.x, from.y, from.z) < std::tie(to.x, to.y, to.z);
        const Point3& begin = forward ? from : to;
        return {begin, (forward ? to : from) - begin};
    }

    bool blocked_by_plane(const Query& shadow) const {
        return std::any_of(objects_.planes.begin(), objects_.planes.end(),
                           [&](const PlaneObject& plane) {
                               const auto t = cross_plane(plane, shadow.origin, shadow.direction);
                               return t && between_ends(*t);
                           });
    }

    /// `query_of(i)`: the query whose answer is `blocked[i]`.
    template <class QueryOf>
    void find_blocked(std::span<char> blocked, const QueryOf& query_of) const {
        std::array<Query, k_packet_size> queries;
        std::array<std::size_t, k_packet_size> places{};
        std::size_t count = 0;
        const auto follow = [&] {
            const unsigned occluded = occluded_packet(traced_, std::span(queries).first(count));
            for (std::size_t i = 0; i < count; ++i) blocked[places[i]] = (occluded >> i & 1U) != 0;
            count = 0;
        };
        for (std::size_t i = 0; i < blocked.size(); ++i) {
            const Query query = query_of(i);
            const bool some_way = query.direction != Vector3(0.0);
            blocked[i] = some_way && blocked_by_plane(query) ? 1 : 0;
            if (!some_way || blocked[i] != 0) continue;
            queries[count] = query;
            places[count++] = i;
            if (count == k_packet_size) follow();
        }
        if (count > 0) follow();
    }

    SceneObjects objects_;
    bool has_textures_ = false;
    EmbreeScene scene_;
    TracedScene traced_;
};

}  // namespace

std::unique_ptr<Surfaces> make_embree_surfaces(SceneObjects objects) {
    return std::make_unique<EmbreeSurfaces>(std::move(objects));
}

}  // namespace uw
