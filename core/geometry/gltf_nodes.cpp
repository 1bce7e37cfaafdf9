#include "core/geometry/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/scene/trajectory.h"

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

namespace {

using Json = nlohmann::json;

/// The keys of a sampler for values of N numbers.
template <std::size_t N>
class Sampler {
  public:
    using Value = std::array<double, N>;

    Sampler(const GltfDocument& document, GltfBytes& bytes, const Json& json)
        : document_(document),
          interpolation_(json.value("interpolation", "LINEAR")),
          per_key_(interpolation_ == "CUBICSPLINE" ? 3 : 1) {
        const Json& input = document.element("accessors", json, "input");
        const Json& output = document.element("accessors", json, "output");
        if (input.value("type", "") != "SCALAR" ||
            output.value("type", "") != (N == 3 ? "VEC3" : "VEC4"))
            document.fail("a glTF animation has values that do not fit what it moves");
        if (interpolation_ != "LINEAR" && interpolation_ != "STEP" && per_key_ == 1)
            document.fail("a glTF animation has an unknown interpolation");
        for (const float time : bytes.floats(input, 1)) times_.push_back(double{time});
        values_ = bytes.floats(output, N);
        if (times_.empty() || values_.size() != N * per_key_ * times_.size())
            document.fail("a glTF animation has not as many values as times");
        const auto is_finite = [](double x) { return std::isfinite(x); };
        if (!std::ranges::all_of(values_, is_finite) || !std::ranges::all_of(times_, is_finite))
            document.fail("a glTF animation has values that are not finite");
        if (std::ranges::adjacent_find(times_, std::greater_equal<>()) != times_.end())
            document.fail("the times of a glTF animation do not ascend");
    }

    Value at(double time) const {
        if (times_.size() == 1) return key(0, per_key_ / 2);
        const KnotSpan span = span_of(times_, time);
        const Value a = key(span.first, per_key_ / 2), b = key(span.first + 1, per_key_ / 2);
        if (interpolation_ == "STEP") return span.fraction < 1 ? a : b;
        if (per_key_ == 3) return cubic(span, a, key(span.first, 2), key(span.first + 1, 0), b);
        if constexpr (N == 4) {
            const Rotation turn = turned(rotation(a), rotation(b), span.fraction);
            return {turn.x, turn.y, turn.z, turn.w};
        } else {
            Value value{};
            for (std::size_t i = 0; i < N; ++i) value[i] = a[i] + span.fraction * (b[i] - a[i]);
            return value;
        }
    }

  private:
    /// In a cubic spline, part 0 is the tangent in, 1 the value and 2 the tangent out.
    Value key(std::size_t index, std::size_t part) const {
        Value value{};
        for (std::size_t i = 0; i < N; ++i)
            value[i] = double{values_[N * (per_key_ * index + part) + i]};
        return value;
    }

    Rotation rotation(const Value& q) const {
        if (std::ranges::all_of(q, [](double x) { return x == 0; }))
            document_.fail("a glTF node's rotation is zero");
        return normalised({q[3], q[0], q[1], q[2]});
    }

    static Value cubic(const KnotSpan& span, const Value& a, const Value& out, const Value& in,
                       const Value& b) {
        const double t = span.fraction, t2 = t * t, t3 = t2 * t;
        Value value{};
        for (std::size_t i = 0; i < N; ++i)
            value[i] = (2 * t3 - 3 * t2 + 1) * a[i] + span.width * (t3 - 2 * t2 + t) * out[i] +
                       (3 * t2 - 2 * t3) * b[i] + span.width * (t3 - t2) * in[i];
        return value;
    }

    const GltfDocument& document_;
    std::string interpolation_;
    std::size_t per_key_;
    std::vector<double> times_;
    std::vector<float> values_;
};

template <std::size_t N>
void set_once(std::optional<std::array<double, N>>& part, const GltfDocument& document,
              GltfBytes& bytes, const Json& sampler, double time) {
    if (!part) part = Sampler<N>(document, bytes, sampler).at(time);
}

}  // namespace

bool moves_node(const GltfDocument& document, const Json& channel) {
    const Json& target = document.object(channel, "target");
    const std::string path = target.value("path", "");
    return document.whole_number(target, "node", UINT64_MAX) < document.list("nodes").size() &&
           (path == "translation" || path == "rotation" || path == "scale");
}

GltfPoses gltf_poses(const GltfDocument& document, GltfBytes& bytes, double time) {
    GltfPoses poses;
    for (const Json& animation : document.list("animations")) {
        const Json& samplers = document.list(animation, "samplers");
        for (const Json& channel : document.list(animation, "channels")) {
            if (!moves_node(document, channel)) continue;
            const std::uint64_t index = document.whole_number(channel, "sampler", UINT64_MAX);
            if (index >= samplers.size())
                document.fail("a glTF animation refers to a sampler that does not exist");
            const Json& target = document.object(channel, "target");
            GltfPose& pose = poses[document.whole_number(target, "node", 0)];
            const std::string path = target.value("path", "");
            const Json& sampler = samplers[index];
            if (path == "rotation")
                set_once(pose.rotation, document, bytes, sampler, time);
            else
                set_once(path == "scale" ? pose.scale : pose.translation, document, bytes, sampler,
                         time);
        }
    }
    return poses;
}

namespace {

constexpr std::size_t k_max_listed = 6;

/// "'a', 'b' and 3 more" of nodes by index.
std::string listed_nodes(const GltfDocument& document, const std::set<std::size_t>& nodes) {
    std::string text;
    std::size_t count = 0;
    for (const std::size_t index : nodes) {
        if (count++ == k_max_listed) {
            return text + fmt::format(" and {} more", nodes.size() - k_max_listed);
        }
        std::string name = document.list("nodes")[index].value("name", "");
        if (name.empty()) name = fmt::format("node{}", index);
        text += fmt::format("{}'{}'", text.empty() ? "" : ", ", printable(name));
    }
    return text;
}

}  // namespace

std::string unused_motion_of(const GltfDocument& document, const GltfUse& use) {
    const nlohmann::json& nodes = document.list("nodes");
    std::set<std::size_t> animated, skinned;
    for (const nlohmann::json& animation : document.list("animations")) {
        for (const nlohmann::json& channel : document.list(animation, "channels")) {
            if (use.time && moves_node(document, channel)) continue;
            const std::uint64_t node =
                document.whole_number(document.object(channel, "target"), "node", UINT64_MAX);
            if (node < nodes.size()) animated.insert(node);
        }
    }
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        if (nodes[node].contains("skin")) skinned.insert(node);
    }
    if (animated.empty() && skinned.empty()) return {};
    std::string what;
    if (!animated.empty())
        what = (use.time ? "morph animations of " : "animations of ") +
               listed_nodes(document, animated);
    if (!skinned.empty())
        what += fmt::format("{}skins of {}", what.empty() ? "" : " and ",
                            listed_nodes(document, skinned));
    return what + " stand still, as the file has them; to move them, export a file for each frame";
}

}  // namespace uw
