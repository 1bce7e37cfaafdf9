#include "core/meshes/files/obj_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/stop.h"
#include "core/base/vec.h"
#include "core/meshes/files/obj_file.h"
#include "core/meshes/files/obj_materials.h"
#include "core/meshes/polygon.h"

namespace uw {
namespace {

// What fits a large machine, not the format's limit.
constexpr std::size_t k_most_corners = 1'500'000'000;
// Combinations at one position that are looked through for a corner's own. A tip where more meet
// has some of them twice, which nobody sees; time stays proportional to the corners.
constexpr int k_most_compared = 64;

/// Makes vertices of the file's positions, texture coordinates and normals, each combination once.
class ObjMesh {
  public:
    ObjMesh(const ObjFile& source, std::vector<MeshMaterial> materials, std::string name)
        : source_(source), name_(std::move(name)) {
        // Faces without a material come last.
        stand_in_ = static_cast<std::uint32_t>(materials.size());
        has_uvs_ = std::ranges::any_of(materials, [](const MeshMaterial& material) {
            return material.base_map || material.emission_map;
        });
        has_normals_ = !source.normals.empty();
        mesh_.materials = std::move(materials);
        const bool needs_stand_in =
            mesh_.materials.empty() || std::ranges::any_of(source.faces, [](const auto& face) {
                return face.material == ObjFile::k_none;
            });
        if (needs_stand_in) mesh_.materials.emplace_back();
        if (needs_stand_in && !source.colors.empty()) mesh_.materials.back().base_color = {1, 1, 1};
    }

    TriangleMesh build() {
        first_of_.assign(source_.positions.size() / 3, ObjFile::k_none);
        mesh_.positions.reserve(source_.positions.size() + 4);  // Embree reads past the last one
        std::span<const ObjCorner> left(source_.corners);
        std::vector<std::uint32_t> corners;
        for (const ObjFile::Face& face : source_.faces) {
            throw_if_stopped();
            corners.clear();
            const std::span<const ObjCorner> own = left.first(face.corners);
            left = left.subspan(face.corners);
            for (const ObjCorner& corner : own) corners.push_back(vertex(corner));
            append(corners);
            const std::uint32_t material =
                face.material == ObjFile::k_none ? stand_in_ : face.material;
            if (mesh_.materials.size() > 1)
                mesh_.triangle_materials.resize(mesh_.triangle_count(), material);
            if (source_.objects.size() > 1)
                mesh_.triangle_objects.resize(mesh_.triangle_count(), face.object);
            const MeshMaterial& used = mesh_.materials[material];
            if (!used.base_map && !used.emission_map) continue;
            const bool lacks_uvs = std::ranges::any_of(
                own, [&](const ObjCorner& corner) { return corner.uv >= source_.uvs.size() / 2; });
            faces_without_uvs_ += lacks_uvs ? 1 : 0;
        }
        return std::move(mesh_);
    }

    std::size_t faces_without_uvs() const { return faces_without_uvs_; }

  private:
    /// A combination of texture coordinates and normal at a position, and the next there.
    struct Vertex {
        std::uint32_t uv = 0, normal = 0, next = ObjFile::k_none;
    };

    std::uint32_t vertex(const ObjCorner& corner) {
        if (corner.position >= first_of_.size()) return ObjFile::k_none;
        const std::uint32_t uv = has_uvs_ ? corner.uv : 0;
        const std::uint32_t normal = has_normals_ ? corner.normal : 0;
        std::uint32_t& first = first_of_[corner.position];
        std::uint32_t known = first;
        for (int k = 0; k < k_most_compared && known != ObjFile::k_none; ++k) {
            const Vertex& vertex = vertices_[known];
            if (vertex.uv == uv && vertex.normal == normal) return known;
            known = vertex.next;
        }
        const auto number = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back({uv, normal, first});
        first = number;
        append_vertex(corner.position, uv, normal);
        return number;
    }

    void append_vertex(std::uint32_t position, std::uint32_t uv, std::uint32_t normal) {
        const auto append = [](const std::vector<float>& from, std::size_t width, std::uint32_t at,
                               std::vector<float>& to) {
            const bool is_there = at < from.size() / width;
            for (std::size_t k = 0; k < width; ++k)
                to.push_back(is_there ? from[width * at + k] : 0.0F);
        };
        append(source_.positions, 3, position, mesh_.positions);
        if (has_uvs_) {
            append(source_.uvs, 2, uv, mesh_.uvs[0]);
            mesh_.uvs[0].back() = 1 - mesh_.uvs[0].back();  // the file's v is up
        }
        if (!source_.colors.empty()) {
            for (std::size_t k = 0; k < 3; ++k) {
                const double code = source_.colors[3 * std::size_t{position} + k];
                mesh_.colors.push_back(static_cast<float>(linear_from_srgb(code)));
            }
        }
        if (!has_normals_) return;
        append(source_.normals, 3, normal, mesh_.normals);
        float* n = &mesh_.normals[mesh_.normals.size() - 3];
        const double length = glm::length(Vector3(n[0], n[1], n[2]));
        for (int axis = 0; axis < 3; ++axis)
            n[axis] = length > 0 ? static_cast<float>(n[axis] / length) : 0.0F;
    }

    void append(const std::vector<std::uint32_t>& corners) {
        if (std::ranges::find(corners, ObjFile::k_none) == corners.end()) {
            triangulate_polygon(corners, mesh_.positions, name_, mesh_.triangles);
        } else {
            mesh_.triangles.insert(mesh_.triangles.end(), 3, ObjFile::k_none);
        }
    }

    const ObjFile& source_;
    std::string name_;
    std::uint32_t stand_in_ = 0;
    bool has_uvs_ = false, has_normals_ = false;
    std::vector<std::uint32_t> first_of_;  // vertex by position
    std::vector<Vertex> vertices_;
    std::size_t faces_without_uvs_ = 0;
    TriangleMesh mesh_;
};

}  // namespace

MeshFile read_obj(const std::filesystem::path& file, bool is_pbr,
                  std::vector<std::string>& warnings) {
    ObjFile source = read_obj_file(file);
    if (source.corners.size() > k_most_corners) {
        throw InputError(file.string() +
                         ": more than 500 million triangles; split or thin out the mesh");
    }
    ObjMesh builder(source,
                    read_obj_materials(file, source.libraries, source.materials, is_pbr, warnings),
                    file.string());
    MeshFile result;
    result.mesh = builder.build();
    if (builder.faces_without_uvs() > 0) {
        warnings.push_back(
            fmt::format("{}: {} faces have a texture but no coordinates for it (vt); they have "
                        "the colour of its corner",
                        file.string(), builder.faces_without_uvs()));
    }
    result.objects = std::move(source.objects);
    result.materials = std::move(source.materials);
    return result;
}

}  // namespace uw
