#include "tests/support/meshes/gltf_truth.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace uw::test {
namespace {

using Json = nlohmann::json;

/// v + 2 w (q x v) + 2 q x (q x v), the rotation by a unit quaternion (q, w).
Vector3 rotated(const Json& quaternion, const Vector3& v) {
    const Vector3 q(quaternion[0], quaternion[1], quaternion[2]);
    const Vector3 t = 2.0 * glm::cross(q, v);
    return v + quaternion[3].get<double>() * t + glm::cross(q, t);
}

Affine local(const Json& node) {
    const Json rotation = node.value("rotation", Json{0.0, 0.0, 0.0, 1.0});
    const Json scale = node.value("scale", Json{1.0, 1.0, 1.0});
    const Json offset = node.value("translation", Json{0.0, 0.0, 0.0});
    Matrix3 linear(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        Vector3 unit(0.0);
        unit[axis] = scale[static_cast<std::size_t>(axis)];
        linear[axis] = rotated(rotation, unit);
    }
    return {linear, Vector3(offset[0], offset[1], offset[2])};
}

struct Reader {
    Json json;
    std::string binary;

    const char* start(std::size_t accessor) const {
        const Json& entry = json["accessors"][accessor];
        const Json& view = json["bufferViews"][entry["bufferView"].get<std::size_t>()];
        return binary.data() + view.value("byteOffset", 0U) + entry.value("byteOffset", 0U);
    }
    Vector3 vector(std::size_t accessor, std::size_t i) const {
        float v[3];
        std::memcpy(v, start(accessor) + 12 * i, sizeof(v));
        return {v[0], v[1], v[2]};
    }
    std::size_t index(std::size_t accessor, std::size_t i) const {
        if (json["accessors"][accessor]["componentType"] != 5123)
            throw std::runtime_error("indices of another kind than Blender's");
        std::uint16_t value = 0;
        std::memcpy(&value, start(accessor) + 2 * i, sizeof(value));
        return value;
    }

    void add_mesh(const Json& mesh, const Affine& world, GltfTruth& truth) const {
        const Matrix3 normal_map = glm::transpose(glm::inverse(world.linear()));
        for (const Json& part : mesh["primitives"]) {
            const std::size_t indices = part["indices"], position = part["attributes"]["POSITION"],
                              normal = part["attributes"]["NORMAL"];
            const std::size_t count = json["accessors"][indices]["count"];
            for (std::size_t i = 0; i < count; i += 3) {
                GltfTruth::Triangle triangle;
                Point3* corners[3] = {&triangle.a, &triangle.b, &triangle.c};
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::size_t vertex = index(indices, i + k);
                    *corners[k] = world * at_origin_plus(vector(position, vertex));
                    triangle.normals[k] = glm::normalize(normal_map * vector(normal, vertex));
                }
                truth.triangles.push_back(triangle);
            }
        }
    }

    void add_node(std::size_t number, const Affine& parent, GltfTruth& truth) const {
        const Json& node = json["nodes"][number];
        GltfTruth::Node place{node["name"], parent * local(node), node.value("camera", -1), -1};
        if (node.contains("extensions"))
            place.light = node["extensions"]["KHR_lights_punctual"]["light"];
        if (node.contains("mesh"))
            add_mesh(json["meshes"][node["mesh"].get<std::size_t>()], place.world, truth);
        if (place.camera >= 0 || place.light >= 0) truth.nodes.push_back(place);
        for (const std::size_t child : node.value("children", std::vector<std::size_t>{}))
            add_node(child, place.world, truth);
    }
};

}  // namespace

GltfTruth::GltfTruth(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof(length));
    const Reader reader{Json::parse(bytes.substr(20, length)), bytes.substr(20 + length + 8)};
    for (const std::size_t root : reader.json["scenes"][0]["nodes"])
        reader.add_node(root, Affine(), *this);
    yfov = reader.json["cameras"][0]["perspective"]["yfov"];
}

const GltfTruth::Node& GltfTruth::node(const std::string& name) const {
    const auto found = std::ranges::find(nodes, name, &Node::name);
    if (found == nodes.end()) throw std::runtime_error("no node " + name);
    return *found;
}

TruthHit first_hit(const GltfTruth& truth, const Ray& ray) {
    TruthHit best;
    for (const GltfTruth::Triangle& triangle : truth.triangles) {
        const Vector3 e1 = triangle.b - triangle.a, e2 = triangle.c - triangle.a;
        const Vector3 p = glm::cross(ray.direction, e2);
        const double determinant = glm::dot(e1, p);
        if (determinant == 0) continue;
        const Vector3 s = ray.origin - triangle.a, q = glm::cross(s, e1);
        const double u = glm::dot(s, p) / determinant;
        const double v = glm::dot(ray.direction, q) / determinant;
        const double t = glm::dot(e2, q) / determinant;
        if (u < 0 || v < 0 || u + v > 1 || t <= 0 || t >= best.t) continue;
        best.t = t;
        best.rim = std::min({u, v, 1 - u - v});
        best.flat = glm::normalize(glm::cross(e1, e2));
        if (glm::dot(best.flat, ray.direction) > 0) best.flat = -best.flat;
        best.normal = glm::normalize((1 - u - v) * triangle.normals[0] + u * triangle.normals[1] +
                                     v * triangle.normals[2]);
        if (glm::dot(best.normal, best.flat) < 0) best.normal = -best.normal;
    }
    return best;
}

}  // namespace uw::test
