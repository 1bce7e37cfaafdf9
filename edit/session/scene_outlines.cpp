#include "edit/session/scene_outlines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "core/meshes/files/mesh_reader.h"

namespace uw {

namespace {

constexpr double k_crease_cosine = 0.8660254037844386;  // of 30 degrees
constexpr int k_circle_sides = 48;

std::array<float, 3> floats_of(const Point3& p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

Point3 point_of(const std::array<float, 3>& p) {
    return {p[0], p[1], p[2]};
}

double length_of(const OutlineSegment& segment) {
    return std::hypot(segment.to[0] - segment.from[0], segment.to[1] - segment.from[1],
                      segment.to[2] - segment.from[2]);
}

/// Collects the segments of one scene.
class Outlines {
  public:
    void add(const GeometryDesc& desc) {
        switch (desc.type) {
            case GeometryDesc::Type::file:
                add_mesh(desc);
                break;
            case GeometryDesc::Type::box:
                add_box(desc);
                break;
            case GeometryDesc::Type::sphere:
                add_sphere(desc);
                break;
            case GeometryDesc::Type::plane:
                break;
        }
    }
    std::vector<OutlineSegment> release() { return std::move(segments_); }

  private:
    // An edge of a mesh while its faces are met.
    struct Edge {
        std::uint32_t a = 0, b = 0;  // vertices
        Vector3 normal{0};           // of the first face
        int faces = 0;
        bool is_crease = false;
    };

    void add_line(const Affine& world_from_line, const Point3& a, const Point3& b) {
        segments_.push_back({floats_of(world_from_line * a), floats_of(world_from_line * b)});
    }

    void add_box(const GeometryDesc& desc) {
        const auto corner = [&](int bits) {
            Point3 p;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = ((bits >> axis) & 1) != 0 ? desc.max[axis] : desc.min[axis];
            return p;
        };
        for (int bits = 0; bits < 8; ++bits)
            for (int axis = 0; axis < 3; ++axis)
                if (((bits >> axis) & 1) == 0)
                    add_line(desc.world_from_object, corner(bits), corner(bits | 1 << axis));
    }

    void add_sphere(const GeometryDesc& desc) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = [&](int i) {
                const double turn = 2 * std::numbers::pi * i / k_circle_sides;
                Vector3 offset(0);
                offset[(axis + 1) % 3] = desc.radius * std::cos(turn);
                offset[(axis + 2) % 3] = desc.radius * std::sin(turn);
                return desc.center + offset;
            };
            for (int i = 0; i < k_circle_sides; ++i)
                add_line(desc.world_from_object, at(i), at(i + 1));
        }
    }

    void add_mesh(const GeometryDesc& desc) {
        MeshFile file;
        try {
            std::vector<std::string> ignored;
            file = read_mesh(desc.file, ignored, {.camera_or_lamps = true});
        } catch (const std::exception&) {
            return;
        }
        add_triangles(desc.world_from_object, file.mesh);
        for (const SharedMesh& shared : file.shared) {
            const std::size_t first = segments_.size();
            add_triangles(Affine(), shared.mesh);
            const std::vector<OutlineSegment> outline(
                segments_.begin() + static_cast<std::ptrdiff_t>(first), segments_.end());
            segments_.resize(first);
            for (const SharedMesh::Placement& placement : shared.placements) {
                const Affine map = desc.world_from_object * placement.file_from_mesh;
                for (const OutlineSegment& line : outline)
                    add_line(map, point_of(line.from), point_of(line.to));
            }
        }
    }

    void add_triangles(const Affine& world_from_mesh, const TriangleMesh& mesh) {
        const auto vertex = [&](std::uint32_t v) {
            const float* p = &mesh.positions[3 * std::size_t{v}];
            return Point3{p[0], p[1], p[2]};
        };
        const std::vector<std::uint32_t> joined = joined_vertices(mesh);
        std::unordered_map<std::uint64_t, Edge> edges;
        for (std::size_t at = 0; at + 2 < mesh.triangles.size(); at += 3) {
            const std::uint32_t* corner = &mesh.triangles[at];
            const Vector3 normal = glm::cross(vertex(corner[1]) - vertex(corner[0]),
                                              vertex(corner[2]) - vertex(corner[0]));
            if (!(glm::length(normal) > 0)) continue;
            for (int k = 0; k < 3; ++k)
                meet(edges, joined[corner[k]], joined[corner[(k + 1) % 3]], glm::normalize(normal));
        }
        for (const auto& [key, edge] : edges)
            if (edge.faces == 1 || edge.is_crease)
                add_line(world_from_mesh, vertex(edge.a), vertex(edge.b));
    }

    static void meet(std::unordered_map<std::uint64_t, Edge>& edges, std::uint32_t a,
                     std::uint32_t b, const Vector3& normal) {
        if (a > b) std::swap(a, b);
        Edge& edge = edges[std::uint64_t{a} << 32 | b];
        if (edge.faces++ == 0) {
            edge.a = a;
            edge.b = b;
            edge.normal = normal;
        } else if (glm::dot(edge.normal, normal) < k_crease_cosine) {
            edge.is_crease = true;
        }
    }

    // For each vertex the first one at its place: files repeat vertices where normals or textures
    // differ.
    static std::vector<std::uint32_t> joined_vertices(const TriangleMesh& mesh) {
        std::map<std::array<float, 3>, std::uint32_t> first;
        std::vector<std::uint32_t> joined;
        joined.reserve(mesh.vertex_count());
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
            const float* p = &mesh.positions[3 * std::size_t{v}];
            joined.push_back(first.try_emplace({p[0], p[1], p[2]}, v).first->second);
        }
        return joined;
    }

    std::vector<OutlineSegment> segments_;
};

}  // namespace

std::vector<OutlineSegment> scene_outlines(const std::vector<GeometryDesc>& geometry,
                                           std::size_t most) {
    Outlines outlines;
    for (const GeometryDesc& desc : geometry) outlines.add(desc);
    std::vector<OutlineSegment> segments = outlines.release();
    const auto is_before = [](const OutlineSegment& a, const OutlineSegment& b) {
        const double x = length_of(a), y = length_of(b);
        return x != y ? x > y : std::tie(a.from, a.to) < std::tie(b.from, b.to);
    };
    std::ranges::sort(segments, is_before);
    if (segments.size() > most) segments.resize(most);
    return segments;
}

}  // namespace uw
