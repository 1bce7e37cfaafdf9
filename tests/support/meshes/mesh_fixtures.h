#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/scene_folder.h"

namespace uw::test {

/// A temporary folder for mesh files written by a test.
class MeshFolder : public SceneFolder {
  public:
    using SceneFolder::path;
    std::filesystem::path path(const std::string& name) const { return path() / name; }
};

/// The bytes of numbers as they lie in memory (little-endian machines).
template <typename T>
std::string bytes_of(const std::vector<T>& numbers) {
    std::string bytes(numbers.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

inline std::string base64(const std::string& bytes) {
    static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const bool there = at + k < bytes.size();
            group = (group << 8) | (there ? static_cast<unsigned char>(bytes[at + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += at + k <= bytes.size() ? digits[(group >> (18 - 6 * k)) & 63] : '=';
        }
    }
    return text;
}

/// The pieces of a small glTF: one triangle (0,0,0) (1,0,0) (0,1,0) with the texture coordinates
/// (0.25, 0.25) and the same colour at each vertex. A test replaces the pieces that it is about;
/// each value is JSON text.
inline std::string gltf_text(const std::map<std::string, std::string>& changes = {}) {
    const std::string buffer = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) +
                               bytes_of<std::uint16_t>({0, 1, 2, 0}) +
                               bytes_of<float>({0.25F, 0.25F, 0.25F, 0.25F, 0.25F, 0.25F}) +
                               bytes_of<float>({.5F, .25F, 1, 1, .5F, .25F, 1, 1, .5F, .25F, 1, 1});
    std::map<std::string, std::string> parts = {
        {"asset", R"({"version":"2.0"})"},
        {"scene", "0"},
        {"scenes", R"([{"nodes":[0]}])"},
        {"nodes", R"([{"mesh":0}])"},
        {"meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])"},
        {"accessors", R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                          {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
                          {"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"},
                          {"bufferView":3,"componentType":5126,"count":3,"type":"VEC4"}])"},
        {"bufferViews", R"([{"buffer":0,"byteOffset":0,"byteLength":36},
                            {"buffer":0,"byteOffset":36,"byteLength":6},
                            {"buffer":0,"byteOffset":44,"byteLength":24},
                            {"buffer":0,"byteOffset":68,"byteLength":48}])"},
        {"buffers", R"([{"byteLength":)" + std::to_string(buffer.size()) +
                        R"(,"uri":"data:application/octet-stream;base64,)" + base64(buffer) +
                        R"("}])"}};
    for (const auto& [key, value] : changes) parts[key] = value;
    std::string text;
    for (const auto& [key, value] : parts) {
        text += (text.empty() ? "{\"" : ",\"") + key + "\":" + value;
    }
    return text + "}";
}

/// A .glb file (glTF 2.0, 4.4) of a JSON text and the contents of its buffer without uri.
inline std::string glb_bytes(std::string json, const std::string& binary = "") {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto word = [](std::size_t value) {
        return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(value)});
    };
    std::string chunks = word(json.size()) + "JSON" + json;
    if (!binary.empty()) chunks += word(binary.size()) + std::string("BIN\0", 4) + binary;
    return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

/// A 2 x 2 PNG of 8-bit sRGB: top row 255,0,0 and 0,255,0; bottom row 0,0,255 and 128,128,128.
inline std::string four_texel_png() {
    static const unsigned char bytes[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49,
        0x48, 0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02,
        0x00, 0x00, 0x00, 0xfd, 0xd4, 0x9a, 0x73, 0x00, 0x00, 0x00, 0x13, 0x49, 0x44,
        0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8, 0xcf, 0xc0, 0xc0, 0x00, 0xc2, 0x0c, 0xff,
        0x1b, 0x1a, 0x1a, 0x00, 0x1c, 0xf4, 0x04, 0x7e, 0x29, 0x80, 0x40, 0xd8, 0x00,
        0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    return {reinterpret_cast<const char*>(bytes), sizeof(bytes)};
}

}  // namespace uw::test
