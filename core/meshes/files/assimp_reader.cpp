#include "core/meshes/files/assimp_reader.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/affine.h"
#include "core/base/error.h"
#include "core/base/stop.h"
#include "core/files/input_files.h"
#include "core/meshes/polygon.h"

namespace uw {
namespace {

// A few nodes may instance a large mesh; this limit is what fits a large machine, not the format's.
constexpr std::uint64_t k_max_corners = 1'500'000'000;

/// Lets Assimp open only regular files.
class RegularFiles : public Assimp::DefaultIOSystem {
  public:
    bool Exists(const char* name) const override { return allowed(name); }
    Assimp::IOStream* Open(const char* name, const char* mode) override {
        if (!allowed(name)) return nullptr;
        return DefaultIOSystem::Open(name, mode);
    }

  private:
    static bool allowed(const std::filesystem::path& name) {
        std::error_code status;
        return std::filesystem::is_regular_file(name, status);
    }
};

/// One node's use of one mesh.
struct Placement {
    const aiMesh* mesh = nullptr;
    Affine file_from_mesh;
};

Affine affine_of(const aiMatrix4x4& m) {
    // Assimp's rows, GLM's columns.
    return {Matrix3(m.a1, m.b1, m.c1, m.a2, m.b2, m.c2, m.a3, m.b3, m.c3),
            Vector3(m.a4, m.b4, m.c4)};
}

std::vector<Placement> placements_of(const aiScene& scene) {
    struct Open {
        const aiNode* node = nullptr;
        Affine file_from_parent;
    };
    std::vector<Placement> placements;
    std::vector<Open> open{{scene.mRootNode, Affine()}};
    while (!open.empty()) {
        const Open next = open.back();
        open.pop_back();
        const Affine file_from_node = next.file_from_parent * affine_of(next.node->mTransformation);
        for (unsigned k = 0; k < next.node->mNumMeshes; ++k) {
            placements.push_back({scene.mMeshes[next.node->mMeshes[k]], file_from_node});
        }
        for (unsigned k = next.node->mNumChildren; k-- > 0;) {
            open.push_back({next.node->mChildren[k], file_from_node});
        }
    }
    return placements;
}

/// Builds one mesh from all placements.
class MeshJoiner {
  public:
    TriangleMesh join(const std::vector<Placement>& placements, const std::string& name) {
        prepare(placements, name);
        for (const Placement& placement : placements) append(placement, name);
        return std::move(mesh_);
    }

  private:
    /// Allocates once, and only what is needed by some part.
    void prepare(const std::vector<Placement>& placements, const std::string& name) {
        std::uint64_t vertices = 0, faces = 0;
        for (const auto& [mesh, transform] : placements) {
            vertices += mesh->mNumVertices;
            faces += mesh->mNumFaces;
        }
        if (vertices > k_max_corners || 3 * faces > k_max_corners) {
            throw InputError(
                fmt::format("{}: more than 500 million triangles; split or thin out "
                            "the mesh",
                            name));
        }
        mesh_.positions.reserve(3 * vertices + 4);  // Embree reads 16 bytes at the last vertex
        mesh_.triangles.reserve(3 * faces);
    }

    void append(const Placement& placement, const std::string& name) {
        const auto first = static_cast<std::uint32_t>(mesh_.vertex_count());
        append_positions(placement);
        append_faces(*placement.mesh, first, name);
    }

    void append_positions(const Placement& placement) {
        const aiMesh& mesh = *placement.mesh;
        for (const aiVector3D& v : std::span(mesh.mVertices, mesh.mNumVertices)) {
            throw_if_stopped();
            const Point3 p = placement.file_from_mesh * Point3{v.x, v.y, v.z};
            for (const double x : {p.x, p.y, p.z}) mesh_.positions.push_back(static_cast<float>(x));
        }
    }

    void append_faces(const aiMesh& mesh, std::uint32_t first, const std::string& name) {
        constexpr std::uint32_t missing = std::numeric_limits<std::uint32_t>::max();
        std::vector<std::uint32_t> corners;
        for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
            throw_if_stopped();
            if (face.mNumIndices < 3) continue;  // points and lines
            corners.clear();
            for (const unsigned corner : std::span(face.mIndices, face.mNumIndices)) {
                if (corner >= mesh.mNumVertices) break;
                corners.push_back(first + corner);
            }
            if (corners.size() != face.mNumIndices) corners.assign(3, missing);
            if (corners.size() == 3) {
                mesh_.triangles.insert(mesh_.triangles.end(), corners.begin(), corners.end());
            } else {
                triangulate_polygon(corners, mesh_.positions, name, mesh_.triangles);
            }
        }
    }

    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_stl(const std::filesystem::path& file) {
    const std::string name = file.string();
    remember_input(file);
    Assimp::Importer importer;
    importer.SetIOHandler(new RegularFiles);  // the importer owns it
    // No post-processing: joining, validating and sorting copy a mesh of millions of triangles
    // several times, and nothing here needs it.
    const aiScene* scene = importer.ReadFile(name, 0);
    if (scene == nullptr || scene->mRootNode == nullptr) {
        std::string message = importer.GetErrorString();
        std::replace(message.begin(), message.end(), '\n', ' ');
        throw InputError(fmt::format("{}: cannot read the mesh: {}", name, message));
    }
    return MeshJoiner().join(placements_of(*scene), name);
}

}  // namespace uw
