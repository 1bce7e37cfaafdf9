#include "core/assimp_reader.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <limits>
#include <span>

#include "core/affine.h"
#include "core/assimp_materials.h"
#include "core/error.h"
#include "core/polygon.h"

namespace uw {
namespace {

// A few nodes may repeat a large mesh; this is what fits a large machine, not a format's limit.
constexpr std::uint64_t k_max_corners = 1'500'000'000;

/// Lets Assimp open regular files only, and no material library: a mesh could name a pipe.
class RegularFiles : public Assimp::DefaultIOSystem {
  public:
    bool Exists(const char* name) const override { return allowed(name); }
    Assimp::IOStream* Open(const char* name, const char* mode) override {
        return allowed(name) ? DefaultIOSystem::Open(name, mode) : nullptr;
    }

  private:
    static bool allowed(const std::filesystem::path& name) {
        std::error_code status;
        return name.extension() != ".mtl" && std::filesystem::is_regular_file(name, status);
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

/// Builds one mesh out of all placements.
class MeshJoiner {
  public:
    MeshJoiner(const AssimpOptions& options, std::string name)
        : options_(options), name_(std::move(name)) {}

    void set_materials(std::vector<AssimpMaterial> materials) {
        materials_ = std::move(materials);
        mesh_.materials.clear();
        for (const AssimpMaterial& m : materials_) mesh_.materials.push_back(m.material);
    }

    TriangleMesh join(const std::vector<Placement>& placements) {
        prepare(placements);
        for (const Placement& placement : placements) append(placement);
        return std::move(mesh_);
    }

    std::uint64_t colors_out_of_range() const { return colors_out_of_range_; }

  private:
    const AssimpMaterial* material_of(const aiMesh& mesh) const {
        return mesh.mMaterialIndex < materials_.size() ? &materials_[mesh.mMaterialIndex] : nullptr;
    }

    /// Assimp appends a stand-in to the materials, for meshes that have none.
    bool has_material(const aiMesh& mesh) const {
        return std::size_t{mesh.mMaterialIndex} + 1 < materials_.size();
    }

    /// Allocates once, and only what some part needs.
    void prepare(const std::vector<Placement>& placements) {
        std::uint64_t vertices = 0, faces = 0;
        for (const auto& [mesh, transform] : placements) {
            vertices += mesh->mNumVertices;
            faces += mesh->mNumFaces;
            has_normals_ |= options_.normals && mesh->mNormals != nullptr;
            if (!options_.materials) continue;
            has_colors_ |= mesh->mColors[0] != nullptr;
            has_uvs_ |= material_of(*mesh) != nullptr && material_of(*mesh)->material.texture;
            has_materials_ |= mesh->mMaterialIndex != placements[0].mesh->mMaterialIndex ||
                              mesh->mMaterialIndex != 0;
        }
        if (vertices > k_max_corners || 3 * faces > k_max_corners) {
            throw InputError(
                fmt::format("{}: more than 500 million triangles; split or thin out "
                            "the mesh",
                            name_));
        }
        if (has_colors_) mesh_.materials.back().base_color = {1, 1, 1};
        mesh_.positions.reserve(3 * vertices + 4);  // Embree reads 16 bytes at the last vertex
        mesh_.triangles.reserve(3 * faces);
        if (has_normals_) mesh_.normals.reserve(3 * vertices);
        if (has_uvs_) mesh_.uvs.reserve(2 * vertices);
        if (has_colors_) mesh_.colors.reserve(3 * vertices);
        if (has_materials_) mesh_.triangle_materials.reserve(faces);
    }

    void append(const Placement& placement) {
        const aiMesh& mesh = *placement.mesh;
        const auto first = static_cast<std::uint32_t>(mesh_.vertex_count());
        append_positions(placement);
        if (has_normals_) append_normals(placement);
        if (has_uvs_) append_uvs(mesh);
        if (has_colors_) append_colors(mesh);
        append_faces(mesh, first);
    }

    void append_positions(const Placement& placement) {
        const aiMesh& mesh = *placement.mesh;
        for (const aiVector3D& v : std::span(mesh.mVertices, mesh.mNumVertices)) {
            const Point3 p = placement.file_from_mesh * Point3{v.x, v.y, v.z};
            for (const double x : {p.x, p.y, p.z}) mesh_.positions.push_back(static_cast<float>(x));
        }
    }

    void append_normals(const Placement& placement) {
        const aiMesh& mesh = *placement.mesh;
        const bool usable = mesh.mNormals != nullptr && placement.file_from_mesh.determinant() != 0;
        const Matrix3 map =
            usable ? glm::transpose(placement.file_from_mesh.inverse().linear()) : Matrix3(0.0);
        for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
            Vector3 n(0.0);
            if (usable) {
                n = map * Vector3(mesh.mNormals[k].x, mesh.mNormals[k].y, mesh.mNormals[k].z);
                const double length = glm::length(n);
                n = length > 0 ? n / length : Vector3(0.0);
            }
            for (int axis = 0; axis < 3; ++axis) {
                mesh_.normals.push_back(static_cast<float>(n[axis]));
            }
        }
    }

    void append_uvs(const aiMesh& mesh) {
        const AssimpMaterial* material = material_of(mesh);
        const bool textured = material != nullptr && material->material.texture;
        const aiVector3D* uvs = nullptr;
        if (textured) {
            if (material->uv_set < AI_MAX_NUMBER_OF_TEXTURECOORDS) {
                uvs = mesh.mTextureCoords[material->uv_set];
            }
            if (uvs == nullptr) {
                throw InputError(
                    fmt::format("{}: mesh '{}' has a texture but not its coordinates "
                                "TEXCOORD_{}; unwrap it or remove the texture",
                                name_, mesh.mName.C_Str(), material->uv_set));
            }
        }
        for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
            // Assimp turned v upwards; glTF's, from the top left, is ours.
            mesh_.uvs.push_back(textured ? uvs[k].x : 0.0F);
            mesh_.uvs.push_back(textured ? 1.0F - uvs[k].y : 0.0F);
        }
    }

    void append_colors(const aiMesh& mesh) {
        const aiColor4D* colors = mesh.mColors[0];
        // Without a material, vertex colours stand alone, and without those too it is neutral grey.
        const auto grey = has_material(mesh) ? 1.0F : 0.5F;
        const aiColor4D plain(grey, grey, grey, 1);
        for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
            const aiColor4D color = colors != nullptr ? colors[k] : plain;
            bool in_range = true;
            for (const float c : {color.r, color.g, color.b}) {
                in_range &= c >= 0 && c <= 1.0001F;
                mesh_.colors.push_back(c > 0 ? std::min(c, 1.0F) : 0.0F);
            }
            colors_out_of_range_ += in_range ? 0 : 1;
        }
    }

    void append_faces(const aiMesh& mesh, std::uint32_t first) {
        constexpr std::uint32_t missing = std::numeric_limits<std::uint32_t>::max();
        std::vector<std::uint32_t> corners;
        for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
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
                triangulate_polygon(corners, mesh_.positions, mesh_.triangles);
            }
        }
        if (has_materials_) {
            mesh_.triangle_materials.resize(mesh_.triangle_count(), mesh.mMaterialIndex);
        }
    }

    AssimpOptions options_;
    std::string name_;
    TriangleMesh mesh_;
    std::vector<AssimpMaterial> materials_;
    bool has_normals_ = false, has_uvs_ = false, has_colors_ = false, has_materials_ = false;
    std::uint64_t colors_out_of_range_ = 0;
};

}  // namespace

TriangleMesh read_with_assimp(const std::filesystem::path& file, const AssimpOptions& options,
                              std::vector<std::string>& warnings) {
    const std::string name = file.string();
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
    const std::vector<Placement> placements = placements_of(*scene);
    MeshJoiner joiner(options, name);
    if (options.materials) joiner.set_materials(read_assimp_materials(*scene, file));
    TriangleMesh mesh = joiner.join(placements);
    if (joiner.colors_out_of_range() > 0) {
        warnings.push_back(fmt::format("{}: {} vertex colours are outside 0..1; clamped", name,
                                       joiner.colors_out_of_range()));
    }
    return mesh;
}

}  // namespace uw
