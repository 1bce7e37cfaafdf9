#include "core/meshes/gltf/gltf_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/meshes/gltf/gltf_inspection.h"
#include "core/meshes/gltf/gltf_materials.h"
#include "core/meshes/gltf/gltf_nodes.h"
#include "core/meshes/mesh_tangents.h"

namespace uw {
namespace {

using Json = nlohmann::json;

// A few nodes may instance a large mesh; this limit is what fits a large machine, not the format's.
constexpr std::uint64_t k_max_corners = 1'500'000'000;

constexpr std::uint64_t k_triangles = 4, k_strip = 5, k_fan = 6;
constexpr std::array<const char*, 2> k_uv_names{"TEXCOORD_0", "TEXCOORD_1"};

/// One node's use of one primitive.
struct Placement {
    const Json* primitive = nullptr;
    std::string mesh_name;
    Affine file_from_mesh;
    std::size_t material = 0;  // index in the resulting mesh
};

/// Builds one mesh from all primitives placed by nodes.
class MeshJoiner {
  public:
    MeshJoiner(const GltfDocument& document, const GltfUse& use)
        : document_(document), bytes_(document), materials_(document, bytes_, use) {}

    TriangleMesh join() {
        const std::size_t stand_in = document_.list("materials").size();
        mesh_.materials.assign(stand_in + 1, MeshMaterial{});
        for (const GltfNode& node : gltf_nodes(document_)) {
            if (node.json->contains("mesh")) place(node, stand_in);
        }
        prepare();
        for (const Placement& placement : placements_) append(placement);
        return std::move(mesh_);
    }

    std::uint64_t colors_out_of_range() const { return colors_out_of_range_; }

  private:
    const Json* attribute(const Placement& placement, const char* semantic) const {
        const Json& attributes = (*placement.primitive)["attributes"];
        return attributes.contains(semantic) ? &document_.element("accessors", attributes, semantic)
                                             : nullptr;
    }

    void place(const GltfNode& node, std::size_t stand_in) {
        const Json& mesh = document_.element("meshes", *node.json, "mesh");
        for (const Json& primitive : document_.list(mesh, "primitives")) {
            const std::uint64_t mode = document_.whole_number(primitive, "mode", k_triangles);
            if (mode < k_triangles) continue;  // points and lines
            if (mode > k_fan) document_.fail("a glTF primitive has an unknown mode");
            Placement placement{&primitive, mesh.value("name", ""), node.file_from_node, stand_in};
            if (primitive.contains("material")) {
                placement.material = document_.whole_number(primitive, "material", 0);
                if (placement.material >= stand_in) {
                    document_.fail("glTF refers to a material that does not exist");
                }
            }
            placements_.push_back(std::move(placement));
        }
    }

    /// Reads the materials in use, and determines what the mesh needs.
    void prepare() {
        std::uint64_t corners = 0, vertices = 0;
        std::vector<bool> is_read(mesh_.materials.size(), false);
        is_read.back() = true;
        for (const Placement& placement : placements_) {
            const Json& positions = *attribute(placement, "POSITION");
            const std::uint64_t count = document_.whole_number(positions, "count", 0);
            vertices += count;
            corners += placement.primitive->contains("indices")
                           ? document_.whole_number(
                                 document_.element("accessors", *placement.primitive, "indices"),
                                 "count", 0)
                           : count;
            MeshMaterial& material = mesh_.materials[placement.material];
            if (!is_read[placement.material]) material = materials_.read(placement.material);
            is_read[placement.material] = true;
            has_normals_ |= attribute(placement, "NORMAL") != nullptr;
            has_colors_ |= attribute(placement, "COLOR_0") != nullptr;
            has_alphas_ |= material.alpha_cutoff > 0 && attribute(placement, "COLOR_0") != nullptr;
            has_tangents_ |= bool(material.normal_map);
            for (const TextureUse& use : maps_of(material)) {
                if (use) has_uvs_[use.uv_set] = true;
            }
            has_materials_ |=
                placement.material != placements_[0].material || placement.material != 0;
        }
        if (vertices > k_max_corners || corners > k_max_corners) {
            document_.fail("more than 500 million triangles; split or thin out the mesh");
        }
        if (has_colors_) mesh_.materials.back().base_color = {1, 1, 1};
        mesh_.positions.reserve(3 * vertices + 4);  // Embree reads 16 bytes at the last vertex
        mesh_.triangles.reserve(corners);
    }

    static std::array<TextureUse, 4> maps_of(const MeshMaterial& material) {
        return {material.base_map, material.emission_map, material.normal_map,
                material.metallic_roughness_map};
    }

    void append(const Placement& placement) {
        const auto first = static_cast<std::uint32_t>(mesh_.vertex_count());
        append_positions(placement);
        const std::size_t count = mesh_.vertex_count() - first;
        if (has_normals_) append_normals(placement, count);
        for (std::size_t set = 0; set < 2; ++set) {
            if (has_uvs_[set]) append_uvs(placement, set, count);
        }
        if (has_colors_) append_colors(placement, count);
        if (has_tangents_) append_tangents(placement, count);
        append_faces(placement, first, static_cast<std::uint32_t>(count));
        if (has_materials_) {
            mesh_.triangle_materials.resize(mesh_.triangle_count(),
                                            static_cast<std::uint32_t>(placement.material));
        }
    }

    void append_positions(const Placement& placement) {
        const std::vector<float> values = bytes_.floats(*attribute(placement, "POSITION"), 3);
        for (std::size_t at = 0; at < values.size(); at += 3) {
            const Point3 p =
                placement.file_from_mesh * Point3{values[at], values[at + 1], values[at + 2]};
            for (int axis = 0; axis < 3; ++axis) {
                mesh_.positions.push_back(static_cast<float>(p[axis]));
            }
        }
    }

    /// Appends directions, `width` numbers apart in `values`, transformed and normalised.
    static void append_directions(const std::vector<float>& values, std::size_t width,
                                  const Matrix3& map, std::vector<float>& to) {
        for (std::size_t at = 0; at < values.size(); at += width) {
            Vector3 v = map * Vector3(values[at], values[at + 1], values[at + 2]);
            const double length = glm::length(v);
            v = length > 0 ? v / length : Vector3(0.0);
            for (int axis = 0; axis < 3; ++axis) to.push_back(static_cast<float>(v[axis]));
            for (std::size_t k = 3; k < width; ++k) to.push_back(values[at + k]);
        }
    }

    void append_normals(const Placement& placement, std::size_t count) {
        const Json* normals = attribute(placement, "NORMAL");
        const double determinant = placement.file_from_mesh.determinant();
        if (normals == nullptr || determinant == 0 || !std::isfinite(determinant)) {
            mesh_.normals.resize(mesh_.normals.size() + 3 * count, 0.0F);
            return;
        }
        append_directions(bytes_.floats(*normals, 3), 3,
                          glm::transpose(placement.file_from_mesh.inverse().linear()),
                          mesh_.normals);
    }

    void append_uvs(const Placement& placement, std::size_t set, std::size_t count) {
        const MeshMaterial& material = mesh_.materials[placement.material];
        const auto maps = maps_of(material);
        const bool is_needed = std::any_of(maps.begin(), maps.end(), [&](const TextureUse& use) {
            return use && use.uv_set == set;
        });
        const Json* uvs = attribute(placement, k_uv_names[set]);
        if (is_needed && uvs == nullptr) {
            document_.fail(
                fmt::format("mesh '{}' has a texture but not the coordinates {} for it; unwrap it "
                            "or remove the texture",
                            placement.mesh_name, k_uv_names[set]));
        }
        std::vector<float>& to = mesh_.uvs[set];
        if (!is_needed) {
            to.resize(to.size() + 2 * count, 0.0F);
            return;
        }
        const std::vector<float> values = bytes_.floats(*uvs, 2);
        to.insert(to.end(), values.begin(), values.end());
    }

    void append_colors(const Placement& placement, std::size_t count) {
        const Json* colors = attribute(placement, "COLOR_0");
        std::vector<float> values;
        if (colors != nullptr) {
            values = bytes_.floats(*colors, 4);
        } else {
            // Without a material, vertex colours are used alone; without those too, neutral grey.
            const bool is_stand_in = placement.material + 1 == mesh_.materials.size();
            values.assign(4 * count, is_stand_in ? 0.5F : 1.0F);
        }
        const bool has_alpha = colors != nullptr && colors->value("type", "") == "VEC4";
        for (std::size_t at = 0; at < values.size(); at += 4) {
            bool in_range = true;
            for (std::size_t k = 0; k < 3; ++k) {
                const float c = values[at + k];
                in_range &= c >= 0 && c <= 1.0001F;
                mesh_.colors.push_back(c > 0 ? std::min(c, 1.0F) : 0.0F);
            }
            colors_out_of_range_ += in_range ? 0 : 1;
            if (has_alphas_) mesh_.alphas.push_back(has_alpha ? values[at + 3] : 1.0F);
        }
    }

    /// From the file, if it has them; else left at zero for compute_tangents.
    void append_tangents(const Placement& placement, std::size_t count) {
        const Json* tangents = attribute(placement, "TANGENT");
        if (tangents == nullptr || attribute(placement, "NORMAL") == nullptr) {
            mesh_.tangents.resize(mesh_.tangents.size() + 4 * count, 0.0F);
            return;
        }
        std::vector<float> values = bytes_.floats(*tangents, 4);
        if (placement.file_from_mesh.determinant() < 0) {  // cross products are reversed
            for (std::size_t at = 3; at < values.size(); at += 4) values[at] = -values[at];
        }
        append_directions(values, 4, placement.file_from_mesh.linear(), mesh_.tangents);
    }

    void append_faces(const Placement& placement, std::uint32_t first, std::uint32_t count) {
        std::vector<std::uint32_t> corners;
        if (placement.primitive->contains("indices")) {
            corners =
                bytes_.indices(document_.element("accessors", *placement.primitive, "indices"));
        } else {
            for (std::uint32_t k = 0; k < count; ++k) corners.push_back(k);
        }
        constexpr std::uint32_t k_missing = UINT32_MAX;
        for (std::uint32_t& corner : corners) corner = corner < count ? first + corner : k_missing;
        const std::uint64_t mode =
            document_.whole_number(*placement.primitive, "mode", k_triangles);
        // A mirroring transform reverses the corner order (glTF 2.0, 3.7.4).
        const bool is_mirrored = placement.file_from_mesh.determinant() < 0;
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            if (is_mirrored) std::swap(b, c);
            for (const std::size_t k : {a, b, c}) mesh_.triangles.push_back(corners[k]);
        };
        if (mode == k_triangles) {
            for (std::size_t k = 0; k + 2 < corners.size(); k += 3) add(k, k + 1, k + 2);
        } else {
            for (std::size_t k = 0; k + 2 < corners.size(); ++k) {
                if (mode == k_strip) add(k, k + 1 + k % 2, k + 2 - k % 2);
                if (mode == k_fan) add(0, k + 1, k + 2);
            }
        }
    }

    const GltfDocument& document_;
    GltfBytes bytes_;
    GltfMaterials materials_;
    std::vector<Placement> placements_;
    TriangleMesh mesh_;
    bool has_normals_ = false, has_colors_ = false, has_alphas_ = false, has_tangents_ = false,
         has_materials_ = false;
    std::array<bool, 2> has_uvs_{};
    std::uint64_t colors_out_of_range_ = 0;
};

}  // namespace

TriangleMesh read_gltf(const std::filesystem::path& file, const GltfUse& use,
                       std::vector<std::string>& warnings) {
    try {
        const GltfDocument document(file);
        const std::vector<std::string> ignored = inspect_gltf(document, use);
        if (!ignored.empty()) {
            warnings.push_back(
                fmt::format("{}: ignored: {}", file.string(), fmt::join(ignored, ", ")));
        }
        MeshJoiner joiner(document, use);
        TriangleMesh mesh = joiner.join();
        if (joiner.colors_out_of_range() > 0) {
            warnings.push_back(fmt::format("{}: {} vertex colours are outside 0..1; clamped",
                                           file.string(), joiner.colors_out_of_range()));
        }
        return mesh;
    } catch (const Json::exception& error) {
        throw InputError(
            fmt::format("{}: the glTF description is broken: {}", file.string(), error.what()));
    }
}

}  // namespace uw
