#include "core/meshes/gltf/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/files/input_files.h"
#include "core/image/image_reader.h"
#include "core/meshes/gltf/gltf_uri.h"

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
/// is counter-clockwise as the texture is seen, its v pointing down.
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

double share_of(const Json& parent, const char* key, double otherwise) {
    return std::clamp(parent.value(key, otherwise), 0.0, 1.0);
}

}  // namespace

std::shared_ptr<const Texture> GltfMaterials::picture(std::size_t image, TextureEncoding encoding,
                                                      bool keep_alpha) {
    std::shared_ptr<const Texture>& known = pictures_[{image, encoding, keep_alpha}];
    if (known) return known;
    const Json& json = document_.list("images")[image];
    const std::string uri = json.value("uri", "");
    const auto decode = [&]() -> PixelImage {
        const std::string name = fmt::format("{}: texture {}", document_.name(),
                                             json.value("name", std::to_string(image)));
        if (uri.starts_with("data:")) return read_image(decode_data_uri(document_, uri), name);
        if (!uri.empty()) {
            const std::filesystem::path file = gltf_uri_path(document_.file(), uri);
            remember_input(file);
            return read_image(file);
        }
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
    if (!use_.pbr) return material;
    material.metallic = share_of(surface, "metallicFactor", 1);
    material.roughness = share_of(surface, "roughnessFactor", 1);
    material.metallic_roughness_map =
        read_texture(surface, "metallicRoughnessTexture", TextureEncoding::linear);
    material.ior = document_.extension(json, "KHR_materials_ior").value("ior", 1.5);
    if (material.ior != 0 && !(material.ior >= 1)) {
        document_.fail("a glTF material has a refractive index below 1");
    }
    return material;
}

}  // namespace uw
