#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/meshes/mesh_fixtures.h"

namespace uw::test {

/// A glTF of one unit square in the plane z = 0, its corners (0,0) (1,0) (1,1) (0,1): u and v run
/// along x and y in the first set of coordinates; in the second, both are 0.75. Attributes other
/// than POSITION and the coordinates are set by the test.
struct TexturedGltf {
    std::string material = "{}";  // JSON
    std::string images = R"([{"uri":"t.png"}])", node = R"({"mesh":0})";
    std::vector<float> normals, tangents;  // per corner, if any
    std::vector<float> colors;             // r, g, b, a

    std::string text() const {
        std::string accessors, views, attributes, buffer;
        int count = 0;
        const auto add = [&](const std::string& semantic, const std::string& bytes,
                             const std::string& type, int component, int elements) {
            const std::string comma = count == 0 ? "" : ",";
            accessors += comma + R"({"bufferView":)" + std::to_string(count) +
                         R"(,"componentType":)" + std::to_string(component) + R"(,"count":)" +
                         std::to_string(elements) + R"(,"type":")" + type + "\"}";
            views += comma + R"({"buffer":0,"byteOffset":)" + std::to_string(buffer.size()) +
                     R"(,"byteLength":)" + std::to_string(bytes.size()) + "}";
            buffer += bytes;
            if (!semantic.empty())
                attributes +=
                    (attributes.empty() ? "\"" : ",\"") + semantic + "\":" + std::to_string(count);
            ++count;
        };
        constexpr int k_floats = 5126, k_shorts = 5123;
        add("", bytes_of<std::uint16_t>({0, 1, 2, 0, 2, 3}), "SCALAR", k_shorts, 6);
        add("POSITION", bytes_of<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), "VEC3", k_floats, 4);
        add("TEXCOORD_0", bytes_of<float>({0, 0, 1, 0, 1, 1, 0, 1}), "VEC2", k_floats, 4);
        add("TEXCOORD_1", bytes_of(std::vector<float>(8, 0.75F)), "VEC2", k_floats, 4);
        if (!normals.empty()) add("NORMAL", bytes_of(normals), "VEC3", k_floats, 4);
        if (!tangents.empty()) add("TANGENT", bytes_of(tangents), "VEC4", k_floats, 4);
        if (!colors.empty()) add("COLOR_0", bytes_of(colors), "VEC4", k_floats, 4);
        return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + node +
               R"(],"meshes":[{"primitives":[{"indices":0,"material":0,"attributes":{)" +
               attributes + R"(}}]}],"materials":[)" + material +
               R"(],"textures":[{"source":0,"sampler":0}],"samplers":[{"magFilter":9728}],"images":)" +
               images + R"(,"accessors":[)" + accessors + R"(],"bufferViews":[)" + views +
               R"(],"buffers":[{"byteLength":)" + std::to_string(buffer.size()) +
               R"(,"uri":"data:application/octet-stream;base64,)" + base64(buffer) + "\"}]}";
    }
};

}  // namespace uw::test
