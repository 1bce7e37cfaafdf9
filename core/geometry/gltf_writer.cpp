#include "core/geometry/gltf_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/version.h"
#include "core/geometry/gltf_document.h"

namespace uw {

using Json = nlohmann::json;

namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

// glTF 2.0, 3.6.2.4, 5.1.3, 5.11.5 and 5.26.
constexpr int k_float = 5126, k_unsigned_int = 5125;
constexpr int k_array_buffer = 34962, k_element_array_buffer = 34963;
constexpr int k_nearest_texel = 9728, k_clamp_to_edge = 33071;

constexpr std::size_t k_alignment = 4;

std::size_t aligned(std::size_t bytes) {
    return (bytes + k_alignment - 1) / k_alignment * k_alignment;
}

/// The parts of the file's buffer, as they are described and then written.
class GlbBuffer {
  public:
    /// Adds a part and returns the number of its view.
    std::size_t add(std::span<const std::byte> bytes, int target = 0) {
        Json view{{"buffer", 0}, {"byteOffset", size_}, {"byteLength", bytes.size()}};
        if (target != 0) view["target"] = target;
        views_.push_back(view);
        parts_.push_back(bytes);
        size_ += aligned(bytes.size());
        return parts_.size() - 1;
    }
    const Json& views() const { return views_; }
    std::size_t size() const { return size_; }
    void write(OutputFile& out) const {
        for (const std::span<const std::byte> part : parts_) {
            out.write(part);
            out.write(std::string(aligned(part.size()) - part.size(), '\0'));
        }
    }

  private:
    Json views_ = Json::array();
    std::vector<std::span<const std::byte>> parts_;
    std::size_t size_ = 0;
};

Json vertex_accessor(GlbBuffer& buffer, std::span<const float> values, std::size_t components) {
    return {{"bufferView", buffer.add(std::as_bytes(values), k_array_buffer)},
            {"componentType", k_float},
            {"count", values.size() / components},
            {"type", components == 3 ? "VEC3" : "VEC2"}};
}

/// The least and greatest coordinates, which positions must have (glTF 2.0, 3.7.2.1).
void add_bounds(Json& accessor, std::span<const float> positions) {
    constexpr float k_far = std::numeric_limits<float>::max();
    std::array<float, 3> low{k_far, k_far, k_far}, high{-k_far, -k_far, -k_far};
    for (std::size_t i = 0; i < positions.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], positions[i]);
        high[i % 3] = std::max(high[i % 3], positions[i]);
    }
    accessor["min"] = low;
    accessor["max"] = high;
}

void write_word(OutputFile& out, std::size_t value) {
    const std::array<std::uint32_t, 1> word{static_cast<std::uint32_t>(value)};
    out.write(std::as_bytes(std::span(word)));
}

}  // namespace

void write_glb(OutputFile& out, const PicturedSurface& surface) {
    GlbBuffer buffer;
    Json attributes, accessors = Json::array();
    const auto add = [&](const char* name, std::span<const float> values, std::size_t components) {
        attributes[name] = accessors.size();
        accessors.push_back(vertex_accessor(buffer, values, components));
    };
    add("POSITION", surface.positions, 3);
    add_bounds(accessors[0], surface.positions);
    if (!surface.normals.empty()) add("NORMAL", surface.normals, 3);
    add("TEXCOORD_0", surface.uvs, 2);
    const std::size_t indices = accessors.size();
    accessors.push_back(
        {{"bufferView", buffer.add(std::as_bytes(surface.triangles), k_element_array_buffer)},
         {"componentType", k_unsigned_int},
         {"count", surface.triangles.size()},
         {"type", "SCALAR"}});
    const std::size_t image = buffer.add(surface.picture);

    Json diffuse{{"metallicFactor", 0}, {"roughnessFactor", 1}};
    Json material{{"name", surface.name}, {"doubleSided", true}};
    if (surface.is_emission) {
        diffuse["baseColorFactor"] = {0, 0, 0, 1};
        material["emissiveFactor"] = {1, 1, 1};
        material["emissiveTexture"] = {{"index", 0}};
    } else {
        diffuse["baseColorTexture"] = {{"index", 0}};
    }
    material["pbrMetallicRoughness"] = diffuse;
    Json primitive{{"attributes", attributes}, {"indices", indices}, {"material", 0}};
    Json mesh{{"name", surface.name}, {"primitives", Json::array({primitive})}};
    Json node{{"name", surface.name}, {"mesh", 0}};
    Json scene{{"nodes", Json::array({0})}};
    Json texture{{"sampler", 0}, {"source", 0}};
    Json sampler{{"magFilter", k_nearest_texel},
                 {"minFilter", k_nearest_texel},
                 {"wrapS", k_clamp_to_edge},
                 {"wrapT", k_clamp_to_edge}};
    Json picture{{"bufferView", image}, {"mimeType", surface.picture_type}};
    Json whole{{"byteLength", buffer.size()}};
    Json asset{{"version", "2.0"}, {"generator", "uwvdb " + program_version()}};
    const Json file{{"asset", asset},
                    {"scene", 0},
                    {"scenes", Json::array({scene})},
                    {"nodes", Json::array({node})},
                    {"meshes", Json::array({mesh})},
                    {"materials", Json::array({material})},
                    {"textures", Json::array({texture})},
                    {"samplers", Json::array({sampler})},
                    {"images", Json::array({picture})},
                    {"accessors", accessors},
                    {"bufferViews", buffer.views()},
                    {"buffers", Json::array({whole})}};

    // A header, a chunk of JSON and one of binary data (glTF 2.0, 4.4).
    // Names come from files and need not be valid UTF-8.
    std::string text = file.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    text.resize(aligned(text.size()), ' ');
    constexpr std::size_t k_header = 12, k_chunk_header = 8;
    const std::size_t size = k_header + 2 * k_chunk_header + text.size() + buffer.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
        throw IoError(
            fmt::format("{}: the mesh would be larger than the 4 GiB that a .glb may have; import "
                        "a smaller image",
                        out.path().string()));
    out.write("glTF");
    write_word(out, 2);
    write_word(out, size);
    write_word(out, text.size());
    out.write("JSON");
    out.write(text);
    write_word(out, buffer.size());
    out.write(std::string_view("BIN\0", 4));
    buffer.write(out);
}

}  // namespace uw
