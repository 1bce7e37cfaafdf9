#include "core/geometry/gltf_primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/gltf_document.h"
#include "core/image/image_file.h"

namespace uw {

namespace {

using Json = nlohmann::json;

constexpr std::uint64_t k_nearest = 9728, k_linear = 9729;
constexpr std::uint64_t k_clamp = 33071, k_mirror = 33648;

TextureWrap wrap_of(std::uint64_t mode) {
    if (mode == k_clamp) return TextureWrap::clamp;
    return mode == k_mirror ? TextureWrap::mirror : TextureWrap::repeat;
}

/// KHR_texture_transform: offset, then rotation, then scale, as matrices are written. The rotation
/// is counter-clockwise on the texture with v pointing down.
std::array<double, 6> transform_of(const Json& extension) {
    const auto offset = extension.value("offset", std::array<double, 2>{0, 0});
    const auto scale = extension.value("scale", std::array<double, 2>{1, 1});
    const double angle = extension.value("rotation", 0.0);
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
}

Rgb color_of(const Json& parent, const char* key, const Rgb& otherwise) {
    Rgb color = otherwise;
    const auto found = parent.find(key);
    if (found == parent.end()) return color;
    for (std::size_t i = 0; i < 3; ++i) {
        color[i] = std::clamp(found->at(i).get<double>(), 0.0, 1.0);
    }
    return color;
}

double fraction_of(const Json& parent, const char* key, double otherwise) {
    return std::clamp(parent.value(key, otherwise), 0.0, 1.0);
}

}  // namespace

std::shared_ptr<const Texture> GltfMaterials::picture(std::size_t image, TextureEncoding encoding,
                                                      bool keep_alpha) {
    std::shared_ptr<const Texture>& known = pictures_[{image, encoding, keep_alpha}];
    if (known) return known;
    const Json& json = document_.list("images")[image];
    const std::string& uri = gltf_uri(json);
    if (!uri.empty() && !uri.starts_with("data:")) {
        const std::filesystem::path file = gltf_uri_path(document_.file(), uri);
        known = uw::read_texture(file, encoding, keep_alpha);
        return known;
    }
    const auto decode = [&]() -> PixelImage {
        const std::string name = fmt::format("{}: texture {}", document_.name(),
                                             printable(json.value("name", std::to_string(image))));
        if (uri.starts_with("data:")) return read_image(decode_data_uri(document_, uri), name);
        return read_image(bytes_.view(json, "bufferView"), name);
    };
    known = std::make_shared<Texture>(decode(), encoding, keep_alpha);
    return known;
}

TextureUse GltfMaterials::read_texture(const Json& parent, const char* key,
                                       TextureEncoding encoding, bool keep_alpha) {
    TextureUse use;
    const Json& info = document_.object(parent, key);
    if (info.empty()) return use;
    const Json& texture = document_.element("textures", info, "index");
    const std::uint64_t image = document_.whole_number(texture, "source", UINT64_MAX);
    if (image >= document_.list("images").size()) {
        document_.fail(fmt::format("a glTF {} has no PNG or JPEG source; export it as PNG", key));
    }
    use.texture = picture(image, encoding, keep_alpha);
    if (texture.contains("sampler")) {
        const Json& sampler = document_.element("samplers", texture, "sampler");
        if (document_.whole_number(sampler, "magFilter", k_linear) == k_nearest) {
            use.lookup.filter = TextureFilter::nearest;
        }
        use.lookup.wrap_u = wrap_of(document_.whole_number(sampler, "wrapS", 0));
        use.lookup.wrap_v = wrap_of(document_.whole_number(sampler, "wrapT", 0));
    }
    const Json& transform = document_.extension(info, "KHR_texture_transform");
    use.transform = transform_of(transform);
    const std::uint64_t uv_set =
        document_.whole_number(transform, "texCoord", document_.whole_number(info, "texCoord", 0));
    if (uv_set > 1) {
        document_.fail(
            fmt::format("a glTF {} uses TEXCOORD_{}, but only the first two are read; "
                        "use one of the mesh's first two UV maps",
                        key, uv_set));
    }
    use.uv_set = uv_set;
    return use;
}

// Transparent by KHR_materials_transmission: a pane without KHR_materials_volume, else solid. The
// base colour is that of light which has passed a pane once.
std::optional<FileGlass> GltfMaterials::read_glass(const Json& json, const Rgb& colour) const {
    const Json& transmission = document_.extension(json, "KHR_materials_transmission");
    if (!is_gltf_glass(transmission)) return std::nullopt;
    // Any length does; the absorption of a pane is that of its thickness.
    constexpr double k_pane = 1e-3;
    constexpr double k_min_fraction = 1e-6;
    const auto absorption_of = [&](const Rgb& left, double distance) {
        Rgb absorption;
        for (std::size_t k = 0; k < 3; ++k)
            absorption[k] =
                -std::log(std::clamp(static_cast<double>(left[k]), k_min_fraction, 1.0)) / distance;
        return absorption;
    };
    FileGlass glass;
    glass.n = document_.extension(json, "KHR_materials_ior").value("ior", 1.5);
    if (!(glass.n >= 1)) document_.fail("a glTF material has a refractive index below 1");
    const Json& volume = document_.extension(json, "KHR_materials_volume");
    glass.is_thin = !(volume.value("thicknessFactor", 0.0) > 0);
    if (glass.is_thin) {
        glass.thickness = k_pane;
        glass.absorption = absorption_of(colour, k_pane);
    } else if (const double distance = volume.value("attenuationDistance", 0.0); distance > 0) {
        glass.absorption = absorption_of(color_of(volume, "attenuationColor", {1, 1, 1}), distance);
    }
    return glass;
}

MeshMaterial GltfMaterials::read(std::size_t index) {
    const Json& json = document_.list("materials")[index];
    const Json& surface = document_.object(json, "pbrMetallicRoughness");
    MeshMaterial material;
    material.number = static_cast<std::uint32_t>(index + 1);
    material.base_color = color_of(surface, "baseColorFactor", {1, 1, 1});
    material.double_sided = json.value("doubleSided", false);
    if (json.value("alphaMode", "OPAQUE") == "MASK") {
        material.alpha_cutoff = std::max(json.value("alphaCutoff", 0.5), 0.0);
        const auto factor = surface.value("baseColorFactor", std::vector<double>{1, 1, 1, 1});
        if (factor.size() == 4) material.alpha = factor[3];
    }
    material.base_map =
        read_texture(surface, "baseColorTexture", TextureEncoding::srgb, material.alpha_cutoff > 0);

    material.emission = color_of(json, "emissiveFactor", {0, 0, 0});
    const Json& strength = document_.extension(json, "KHR_materials_emissive_strength");
    const double factor = std::max(strength.value("emissiveStrength", 1.0), 0.0);
    for (double& part : material.emission) part *= factor;
    if (material.emission != Rgb{0, 0, 0}) {
        material.emission_map = read_texture(json, "emissiveTexture", TextureEncoding::srgb);
    }

    material.normal_map = read_texture(json, "normalTexture", TextureEncoding::linear);
    material.normal_scale = document_.object(json, "normalTexture").value("scale", 1.0);
    material.glass = read_glass(json, material.base_color);
    if (!use_.pbr) return material;
    material.metallic = fraction_of(surface, "metallicFactor", 1);
    material.roughness = fraction_of(surface, "roughnessFactor", 1);
    material.metallic_roughness_map =
        read_texture(surface, "metallicRoughnessTexture", TextureEncoding::linear);
    material.ior = document_.extension(json, "KHR_materials_ior").value("ior", 1.5);
    if (material.ior != 0 && !(material.ior >= 1)) {
        document_.fail("a glTF material has a refractive index below 1");
    }
    return material;
}

namespace {

using Json = nlohmann::json;

// A few nodes may instance a large mesh; this limit is what fits a large machine, not the format's.
constexpr std::uint64_t k_max_corners = 1'500'000'000;

constexpr std::uint64_t k_triangles = 4, k_strip = 5, k_fan = 6;
constexpr std::array<const char*, 2> k_uv_names{"TEXCOORD_0", "TEXCOORD_1"};

/// One mesh while it is built.
class JoinedMesh {
  public:
    JoinedMesh(const GltfDocument& document, GltfBytes& bytes)
        : document_(document), bytes_(bytes) {}

    TriangleMesh join(const std::vector<GltfPlacement>& placements, GltfMaterials& materials) {
        if (placements.empty()) return {};
        read_materials(placements, materials);
        prepare(placements);
        for (const GltfPlacement& placement : placements) append(placement);
        return std::move(mesh_);
    }

    const NormalisedWeights& normalised() const { return normalised_; }

  private:
    const Json* attribute(const GltfPlacement& placement, const char* semantic) const {
        const Json& attributes = (*placement.primitive)["attributes"];
        return attributes.contains(semantic) ? &document_.element("accessors", attributes, semantic)
                                             : nullptr;
    }

    const MeshMaterial& material_of(const GltfPlacement& placement) const {
        return mesh_.materials[local_.at(placement.material)];
    }

    /// Those in use, in the file's order.
    void read_materials(const std::vector<GltfPlacement>& placements, GltfMaterials& materials) {
        for (const GltfPlacement& placement : placements) local_.try_emplace(placement.material);
        mesh_.materials.clear();
        for (auto& [in_file, local] : local_) {
            local = static_cast<std::uint32_t>(mesh_.materials.size());
            const bool is_stand_in = in_file == document_.list("materials").size();
            mesh_.materials.push_back(is_stand_in ? MeshMaterial{} : materials.read(in_file));
        }
    }

    /// Determines what the mesh needs.
    void prepare(const std::vector<GltfPlacement>& placements) {
        std::uint64_t corners = 0, vertices = 0;
        for (const GltfPlacement& placement : placements) {
            const Json& positions = *attribute(placement, "POSITION");
            const std::uint64_t count = document_.whole_number(positions, "count", 0);
            vertices += count;
            corners += placement.primitive->contains("indices")
                           ? document_.whole_number(
                                 document_.element("accessors", *placement.primitive, "indices"),
                                 "count", 0)
                           : count;
            const MeshMaterial& material = material_of(placement);
            has_normals_ |= attribute(placement, "NORMAL") != nullptr;
            has_colors_ |= attribute(placement, "COLOR_0") != nullptr;
            has_alphas_ |= material.alpha_cutoff > 0 && attribute(placement, "COLOR_0") != nullptr;
            has_tangents_ |= bool(material.normal_map);
            has_objects_ |= placement.object != 0;
            for (const TextureUse& use : maps_of(material)) {
                if (use) has_uvs_[use.uv_set] = true;
            }
        }
        if (vertices > k_max_corners || corners > k_max_corners) {
            document_.fail("more than 500 million triangles; split or thin out the mesh");
        }
        if (MeshMaterial& last = mesh_.materials.back(); has_colors_ && last.number == 0) {
            last.base_color = {1, 1, 1};  // the colours alone
        }
        mesh_.positions.reserve(3 * vertices + 4);  // Embree reads 16 bytes at the last vertex
        mesh_.triangles.reserve(corners);
    }

    static std::array<TextureUse, 4> maps_of(const MeshMaterial& material) {
        return {material.base_map, material.emission_map, material.normal_map,
                material.metallic_roughness_map};
    }

    void append(const GltfPlacement& placement) {
        const auto first = static_cast<std::uint32_t>(mesh_.vertex_count());
        if (placement.deformation != nullptr)
            append_deformed(placement);
        else
            append_rigid(placement);
        const std::size_t count = mesh_.vertex_count() - first;
        for (std::size_t set = 0; set < 2; ++set) {
            if (has_uvs_[set]) append_uvs(placement, set, count);
        }
        if (has_colors_) append_colors(placement, count);
        append_faces(placement, first, static_cast<std::uint32_t>(count));
        if (mesh_.materials.size() > 1) {
            mesh_.triangle_materials.resize(mesh_.triangle_count(), local_.at(placement.material));
        }
        if (has_objects_) mesh_.triangle_objects.resize(mesh_.triangle_count(), placement.object);
    }

    bool has_own_tangents(const GltfPlacement& placement) const {
        return attribute(placement, "TANGENT") != nullptr &&
               attribute(placement, "NORMAL") != nullptr;
    }

    void append_rigid(const GltfPlacement& placement) {
        const std::size_t before = mesh_.vertex_count();
        append_positions(placement);
        const std::size_t count = mesh_.vertex_count() - before;
        if (has_normals_) append_normals(placement, count);
        if (has_tangents_) append_tangents(placement, count);
        is_mirrored_ = placement.file_from_mesh.determinant() < 0;
    }

    void append_deformed(const GltfPlacement& placement) {
        const DeformedPrimitive primitive = deformed(document_, bytes_, placement);
        normalised_.unweighted += primitive.normalised().unweighted;
        normalised_.unbalanced += primitive.normalised().unbalanced;
        const auto add = [](std::vector<float>& to, const std::vector<float>& values) {
            to.insert(to.end(), values.begin(), values.end());
        };
        add(mesh_.positions, primitive.positions());
        const std::size_t vertices = mesh_.vertex_count();
        if (has_normals_) {
            if (attribute(placement, "NORMAL") != nullptr) add(mesh_.normals, primitive.normals());
            mesh_.normals.resize(3 * vertices, 0.0F);
        }
        if (has_tangents_) {
            if (has_own_tangents(placement)) add(mesh_.tangents, primitive.tangents());
            mesh_.tangents.resize(4 * vertices, 0.0F);
        }
        is_mirrored_ = primitive.is_mirrored();
    }

    void append_positions(const GltfPlacement& placement) {
        const std::vector<float> values = bytes_.floats(*attribute(placement, "POSITION"), 3);
        for (std::size_t at = 0; at < values.size(); at += 3) {
            throw_if_stopped();
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
            throw_if_stopped();
            Vector3 v = map * Vector3(values[at], values[at + 1], values[at + 2]);
            const double length = glm::length(v);
            v = length > 0 ? v / length : Vector3(0.0);
            for (int axis = 0; axis < 3; ++axis) to.push_back(static_cast<float>(v[axis]));
            for (std::size_t k = 3; k < width; ++k) to.push_back(values[at + k]);
        }
    }

    void append_normals(const GltfPlacement& placement, std::size_t count) {
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

    void append_uvs(const GltfPlacement& placement, std::size_t set, std::size_t count) {
        const auto maps = maps_of(material_of(placement));
        const bool is_needed = std::any_of(maps.begin(), maps.end(), [&](const TextureUse& use) {
            return use && use.uv_set == set;
        });
        const Json* uvs = attribute(placement, k_uv_names[set]);
        if (is_needed && uvs == nullptr) {
            document_.fail(
                fmt::format("mesh '{}' has a texture but not the coordinates {} for it; unwrap it "
                            "or remove the texture",
                            printable(placement.mesh->value("name", "")), k_uv_names[set]));
        }
        std::vector<float>& to = mesh_.uvs[set];
        if (!is_needed) {
            to.resize(to.size() + 2 * count, 0.0F);
            return;
        }
        const std::vector<float> values = bytes_.floats(*uvs, 2);
        to.insert(to.end(), values.begin(), values.end());
    }

    void append_colors(const GltfPlacement& placement, std::size_t count) {
        const Json* colors = attribute(placement, "COLOR_0");
        std::vector<float> values;
        if (colors != nullptr) {
            values = bytes_.floats(*colors, 4);
        } else {
            // Without a material, vertex colours are used alone; without those too, neutral grey.
            const bool is_stand_in = material_of(placement).number == 0;
            values.assign(4 * count, is_stand_in ? 0.5F : 1.0F);
        }
        const bool has_alpha = colors != nullptr && colors->value("type", "") == "VEC4";
        for (std::size_t at = 0; at < values.size(); at += 4) {
            for (std::size_t k = 0; k < 3; ++k) mesh_.colors.push_back(values[at + k]);
            if (has_alphas_) mesh_.alphas.push_back(has_alpha ? values[at + 3] : 1.0F);
        }
    }

    /// From the file, if it has them; else left at zero for compute_tangents.
    void append_tangents(const GltfPlacement& placement, std::size_t count) {
        if (!has_own_tangents(placement)) {
            mesh_.tangents.resize(mesh_.tangents.size() + 4 * count, 0.0F);
            return;
        }
        std::vector<float> values = bytes_.floats(*attribute(placement, "TANGENT"), 4);
        if (placement.file_from_mesh.determinant() < 0) {  // cross products are reversed
            for (std::size_t at = 3; at < values.size(); at += 4) values[at] = -values[at];
        }
        append_directions(values, 4, placement.file_from_mesh.linear(), mesh_.tangents);
    }

    void append_faces(const GltfPlacement& placement, std::uint32_t first, std::uint32_t count) {
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
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            throw_if_stopped();
            if (is_mirrored_) std::swap(b, c);
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
    GltfBytes& bytes_;
    TriangleMesh mesh_;
    std::map<std::size_t, std::uint32_t> local_;  // materials by their place in the file
    bool has_normals_ = false, has_colors_ = false, has_alphas_ = false, has_tangents_ = false,
         has_objects_ = false;
    bool is_mirrored_ = false;  // the placement in progress
    std::array<bool, 2> has_uvs_{};
    NormalisedWeights normalised_;
};

}  // namespace

TriangleMesh GltfJoiner::join(const std::vector<GltfPlacement>& placements) {
    JoinedMesh joined(document_, bytes_);
    TriangleMesh mesh = joined.join(placements, materials_);
    normalised_.unweighted += joined.normalised().unweighted;
    normalised_.unbalanced += joined.normalised().unbalanced;
    return mesh;
}

DeformedPrimitive deformed(const GltfDocument& document, GltfBytes& bytes,
                           const GltfPlacement& placement) {
    return {document,
            bytes,
            *placement.primitive,
            *placement.deformation,
            placement.file_from_mesh,
            printable(placement.mesh->value("name", ""))};
}

}  // namespace uw
