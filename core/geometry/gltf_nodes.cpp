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

/// The keys of a sampler.
class Sampler {
  public:
    using Value = std::vector<double>;

    /// `type` is that of the accessor of its values, of which `per_value` elements form a value.
    Sampler(const GltfDocument& document, GltfBytes& bytes, const Json& json,
            const std::string& type, std::size_t per_value)
        : document_(document),
          interpolation_(json.value("interpolation", "LINEAR")),
          per_key_(interpolation_ == "CUBICSPLINE" ? 3 : 1),
          width_(gltf_component_count(type) * per_value) {
        const Json& input = document.element("accessors", json, "input");
        const Json& output = document.element("accessors", json, "output");
        if (input.value("type", "") != "SCALAR" || output.value("type", "") != type)
            document.fail("a glTF animation has values that do not fit what it moves");
        if (interpolation_ != "LINEAR" && interpolation_ != "STEP" && per_key_ == 1)
            document.fail("a glTF animation has an unknown interpolation");
        for (const float time : bytes.floats(input, 1)) times_.push_back(double{time});
        values_ = bytes.floats(output, gltf_component_count(type));
        if (times_.empty() || values_.size() != width_ * per_key_ * times_.size())
            document.fail("a glTF animation has not as many values as times");
        const auto is_finite = [](double x) { return std::isfinite(x); };
        if (!std::ranges::all_of(values_, is_finite) || !std::ranges::all_of(times_, is_finite))
            document.fail("a glTF animation has values that are not finite");
        if (std::ranges::adjacent_find(times_, std::greater_equal<>()) != times_.end())
            document.fail("the times of a glTF animation do not ascend");
    }

    Value at(double time) const {
        return between(time, [](const KnotSpan& span, const Value& a, const Value& b) {
            Value value = a;
            for (std::size_t i = 0; i < a.size(); ++i) value[i] += span.fraction * (b[i] - a[i]);
            return value;
        });
    }

    /// Returns the value of a channel of rotations (x, y, z, w), which turn at a steady rate.
    Value turned_at(double time) const {
        return between(time, [&](const KnotSpan& span, const Value& a, const Value& b) -> Value {
            const Rotation turn = turned(rotation(a), rotation(b), span.fraction);
            return {turn.x, turn.y, turn.z, turn.w};
        });
    }

  private:
    /// `linear(span, a, b)` interpolates linearly between the values of two keys.
    template <class Linear>
    Value between(double time, const Linear& linear) const {
        if (times_.size() == 1) return key(0, per_key_ / 2);
        const KnotSpan span = span_of(times_, time);
        const Value a = key(span.first, per_key_ / 2), b = key(span.first + 1, per_key_ / 2);
        if (interpolation_ == "STEP") return span.fraction < 1 ? a : b;
        if (per_key_ == 3) return cubic(span, a, key(span.first, 2), key(span.first + 1, 0), b);
        return linear(span, a, b);
    }

    /// In a cubic spline, part 0 is the tangent in, 1 the value and 2 the tangent out.
    Value key(std::size_t index, std::size_t part) const {
        const float* first = &values_[width_ * (per_key_ * index + part)];
        return {first, first + width_};
    }

    Rotation rotation(const Value& q) const {
        if (std::ranges::all_of(q, [](double x) { return x == 0; }))
            document_.fail("a glTF node's rotation is zero");
        return normalised({q[3], q[0], q[1], q[2]});
    }

    static Value cubic(const KnotSpan& span, const Value& a, const Value& out, const Value& in,
                       const Value& b) {
        const double t = span.fraction, t2 = t * t, t3 = t2 * t;
        Value value(a.size());
        for (std::size_t i = 0; i < a.size(); ++i)
            value[i] = (2 * t3 - 3 * t2 + 1) * a[i] + span.width * (t3 - 2 * t2 + t) * out[i] +
                       (3 * t2 - 2 * t3) * b[i] + span.width * (t3 - t2) * in[i];
        return value;
    }

    const GltfDocument& document_;
    std::string interpolation_;
    std::size_t per_key_, width_;
    std::vector<double> times_;
    std::vector<float> values_;
};

/// The node that a channel moves; it exists (moves_node).
const Json& target_node(const GltfDocument& document, const Json& channel) {
    return document.list(
        "nodes")[document.whole_number(document.object(channel, "target"), "node", UINT64_MAX)];
}

/// Sets the part of a pose that a channel moves, unless another one has.
void set_part(GltfPose& pose, const GltfDocument& document, GltfBytes& bytes, const Json& channel,
              const Json& sampler, double time) {
    const std::string path = document.object(channel, "target").value("path", "");
    if (path == "weights") {
        if (pose.weights) return;
        const std::size_t targets = gltf_target_count(document, target_node(document, channel));
        pose.weights = Sampler(document, bytes, sampler, "SCALAR", targets).at(time);
    } else if (path == "rotation") {
        if (pose.rotation) return;
        const auto q = Sampler(document, bytes, sampler, "VEC4", 1).turned_at(time);
        pose.rotation = std::array{q[0], q[1], q[2], q[3]};
    } else {
        auto& part = path == "scale" ? pose.scale : pose.translation;
        if (part) return;
        const auto v = Sampler(document, bytes, sampler, "VEC3", 1).at(time);
        part = std::array{v[0], v[1], v[2]};
    }
}

}  // namespace

std::size_t gltf_target_count(const GltfDocument& document, const nlohmann::json& node) {
    if (!node.contains("mesh")) return 0;
    const Json& primitives = document.list(document.element("meshes", node, "mesh"), "primitives");
    return primitives.empty() ? 0 : document.list(primitives[0], "targets").size();
}

bool moves_node(const GltfDocument& document, const Json& channel) {
    const Json& target = document.object(channel, "target");
    const std::string path = target.value("path", "");
    if (document.whole_number(target, "node", UINT64_MAX) >= document.list("nodes").size())
        return false;
    if (path == "weights") return gltf_target_count(document, target_node(document, channel)) > 0;
    return path == "translation" || path == "rotation" || path == "scale";
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
            set_part(poses[document.whole_number(target, "node", 0)], document, bytes, channel,
                     samplers[index], time);
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
    std::set<std::size_t> animated;
    for (const nlohmann::json& animation : document.list("animations")) {
        for (const nlohmann::json& channel : document.list(animation, "channels")) {
            if (use.time && moves_node(document, channel)) continue;
            const std::uint64_t node =
                document.whole_number(document.object(channel, "target"), "node", UINT64_MAX);
            if (node < nodes.size()) animated.insert(node);
        }
    }
    if (animated.empty()) return {};
    return "animations of " + listed_nodes(document, animated) +
           " stand still, as the file has them; to move them, export a file for each frame";
}

}  // namespace uw
