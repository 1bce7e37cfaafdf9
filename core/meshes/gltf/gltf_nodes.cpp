#include "core/meshes/gltf/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace uw {
namespace {

using Json = nlohmann::json;

constexpr std::size_t k_max_depth = 256;
constexpr std::size_t k_no_parent = SIZE_MAX;

template <std::size_t N>
std::array<double, N> numbers(const GltfDocument& document, const Json& node, const char* key,
                              const std::array<double, N>& otherwise) {
    const auto found = node.find(key);
    if (found == node.end()) return otherwise;
    if (!found->is_array() || found->size() != N) {
        document.fail(fmt::format("glTF node '{}' does not have {} numbers", key, N));
    }
    return found->get<std::array<double, N>>();
}

/// The rotation by a quaternion x, y, z, w of any non-zero length.
Matrix3 rotation_of(const GltfDocument& document, const std::array<double, 4>& q) {
    const double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (!(norm > 0)) document.fail("a glTF node's rotation is zero");
    const double s = 2 / norm;
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    // Columns.
    return Matrix3(1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w),  //
                   s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w),  //
                   s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y));
}

Affine parent_from_node(const GltfDocument& document, const Json& node, const GltfPose& pose) {
    if (node.contains("matrix")) {
        if (pose.translation || pose.rotation || pose.scale)
            document.fail(
                "a glTF node with a matrix is animated; export it with its "
                "translation, rotation and scale");
        const auto m = numbers<16>(document, node, "matrix", {});  // by columns
        return {Matrix3(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]),
                Vector3(m[12], m[13], m[14])};
    }
    const auto t = pose.translation.value_or(numbers<3>(document, node, "translation", {0, 0, 0}));
    const auto r = pose.rotation.value_or(numbers<4>(document, node, "rotation", {0, 0, 0, 1}));
    const auto s = pose.scale.value_or(numbers<3>(document, node, "scale", {1, 1, 1}));
    Matrix3 linear = rotation_of(document, r);
    for (int column = 0; column < 3; ++column) linear[column] *= s[std::size_t(column)];
    return {linear, Vector3(t[0], t[1], t[2])};
}

std::size_t index_of(const GltfDocument& document, const Json& index, std::size_t count) {
    if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= count) {
        document.fail("glTF refers to a node that does not exist");
    }
    return index.get<std::size_t>();
}

std::vector<std::size_t> parents_of(const GltfDocument& document) {
    const Json& nodes = document.list("nodes");
    std::vector<std::size_t> parent(nodes.size(), k_no_parent);
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        for (const Json& child : document.list(nodes[node], "children")) {
            const std::size_t index = index_of(document, child, nodes.size());
            if (parent[index] != k_no_parent) document.fail("a glTF node has two parents");
            parent[index] = node;
        }
    }
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        std::size_t depth = 0;
        for (std::size_t at = node; parent[at] != k_no_parent; at = parent[at]) {
            if (++depth > k_max_depth) {
                document.fail("the glTF nodes form a cycle or are nested more than 256 deep");
            }
        }
    }
    return parent;
}

std::vector<std::size_t> roots_of(const GltfDocument& document,
                                  const std::vector<std::size_t>& parent) {
    const Json& scenes = document.list("scenes");
    std::vector<std::size_t> roots;
    if (scenes.empty()) {
        for (std::size_t node = 0; node < parent.size(); ++node) {
            if (parent[node] == k_no_parent) roots.push_back(node);
        }
        return roots;
    }
    const std::uint64_t shown = document.whole_number(document.root(), "scene", 0);
    if (shown >= scenes.size()) document.fail("glTF 'scene' refers to an item that does not exist");
    std::vector<bool> taken(parent.size(), false);
    for (const Json& root : document.list(scenes[shown], "nodes")) {
        const std::size_t index = index_of(document, root, parent.size());
        if (parent[index] != k_no_parent || taken[index]) {
            document.fail("a glTF scene lists a node that is not a root, or lists one twice");
        }
        taken[index] = true;
        roots.push_back(index);
    }
    return roots;
}

}  // namespace

std::vector<GltfNode> gltf_nodes(const GltfDocument& document, const GltfPoses& poses) {
    const Json& nodes = document.list("nodes");
    struct Open {
        std::size_t index = 0;
        Affine file_from_parent;
    };
    std::vector<Open> open;
    for (const std::size_t root : roots_of(document, parents_of(document))) {
        open.push_back({root, Affine()});
    }
    std::vector<GltfNode> result;
    std::reverse(open.begin(), open.end());
    while (!open.empty()) {
        const Open next = open.back();
        open.pop_back();
        const Json& node = nodes[next.index];
        const auto posed = poses.find(next.index);
        const Affine file_from_node =
            next.file_from_parent *
            parent_from_node(document, node, posed == poses.end() ? GltfPose() : posed->second);
        result.push_back({next.index, &node, file_from_node});
        const Json& children = document.list(node, "children");
        for (std::size_t k = children.size(); k-- > 0;) {
            open.push_back({children[k].get<std::size_t>(), file_from_node});
        }
    }
    return result;
}

}  // namespace uw
