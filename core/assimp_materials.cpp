#include "core/assimp_materials.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <string>

#include "core/error.h"
#include "core/gltf_uri.h"
#include "core/image_reader.h"

namespace uw {
namespace {

constexpr int k_gl_nearest = 9728, k_gl_linear = 9729;

using TextureCache = std::map<std::string, std::shared_ptr<const Texture>>;

std::shared_ptr<const Texture> load_texture(const aiScene& scene, const std::string& path,
                                            const std::filesystem::path& file) {
    const aiTexture* embedded = scene.GetEmbeddedTexture(path.c_str());
    if (embedded == nullptr) {
        return std::make_shared<Texture>(read_image(gltf_uri_path(file, path)));
    }
    const std::string name = fmt::format("{}: texture {}", file.string(), path);
    if (embedded->mHeight != 0) throw InputError(name + ": neither PNG nor JPEG");
    const auto* bytes = reinterpret_cast<const std::byte*>(embedded->pcData);
    return std::make_shared<Texture>(read_image(std::span(bytes, embedded->mWidth), name));
}

TextureWrap wrap_of(const aiMaterial& material, const char* key) {
    int mode = aiTextureMapMode_Wrap;
    material.Get(key, aiTextureType_BASE_COLOR, 0, mode);
    if (mode == aiTextureMapMode_Clamp) return TextureWrap::clamp;
    return mode == aiTextureMapMode_Mirror ? TextureWrap::mirror : TextureWrap::repeat;
}

AssimpMaterial convert(const aiScene& scene, const aiMaterial& source,
                       const std::filesystem::path& file, TextureCache& cache) {
    AssimpMaterial result;
    aiColor4D factor(1, 1, 1, 1);
    source.Get(AI_MATKEY_BASE_COLOR, factor);
    result.material.base_color = {std::clamp<double>(factor.r, 0, 1),
                                  std::clamp<double>(factor.g, 0, 1),
                                  std::clamp<double>(factor.b, 0, 1)};
    result.material.double_sided = false;
    source.Get(AI_MATKEY_TWOSIDED, result.material.double_sided);

    aiString path;
    if (source.GetTexture(aiTextureType_BASE_COLOR, 0, &path) != aiReturn_SUCCESS) return result;
    auto& texture = cache[path.C_Str()];
    if (!texture) texture = load_texture(scene, path.C_Str(), file);
    result.material.texture = texture;
    int filter = k_gl_linear, uv_set = 0;
    source.Get(AI_MATKEY_GLTF_MAPPINGFILTER_MAG(aiTextureType_BASE_COLOR, 0), filter);
    source.Get(AI_MATKEY_UVWSRC(aiTextureType_BASE_COLOR, 0), uv_set);
    result.uv_set = static_cast<unsigned>(std::max(uv_set, 0));
    result.material.lookup = {
        filter == k_gl_nearest ? TextureFilter::nearest : TextureFilter::linear,
        wrap_of(source, _AI_MATKEY_MAPPINGMODE_U_BASE),
        wrap_of(source, _AI_MATKEY_MAPPINGMODE_V_BASE)};
    return result;
}

}  // namespace

std::vector<AssimpMaterial> read_assimp_materials(const aiScene& scene,
                                                  const std::filesystem::path& file) {
    TextureCache cache;
    std::vector<AssimpMaterial> materials;
    for (unsigned k = 0; k + 1 < scene.mNumMaterials; ++k) {
        materials.push_back(convert(scene, *scene.mMaterials[k], file, cache));
    }
    materials.emplace_back();
    return materials;
}

}  // namespace uw
