#include "core/geometry/gltf_deformation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

using Json = nlohmann::json;

// A file may have any number of sets of four joints per vertex.
constexpr int k_max_joint_sets = 16;
// Weights in bytes are off by up to 0.8 %.
constexpr double k_weight_tolerance = 0.01;

std::string name_or_number(const Json& named, const char* kind, std::size_t number) {
    const std::string name = named.value("name", "");
    return printable(name.empty() ? fmt::format("{}{}", kind, number) : name);
}

/// The inverse transpose of a map's linear part, up to a positive factor; none of it is lost if the
/// map is singular.
Matrix3 normal_map(const Matrix3& m) {
    const Matrix3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::dot(m[0], cofactors[0]) < 0 ? -1.0 * cofactors : cofactors;
}

Vector3 unit_or_none(const Vector3& v) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : Vector3(0.0);
}

}  // namespace

GltfDeformations::GltfDeformations(const GltfDocument& document, GltfBytes& bytes,
                                   const GltfPoses& poses, const std::vector<GltfNode>& nodes)
    : document_(document), bytes_(bytes), poses_(poses) {
    for (const GltfNode& node : nodes) file_from_node_.emplace(node.index, node.file_from_node);
    for (const Json& animation : document.list("animations"))
        for (const Json& channel : document.list(animation, "channels")) {
            const Json& target = document.object(channel, "target");
            if (target.value("path", "") == "weights")
                animated_.insert(document.whole_number(target, "node", SIZE_MAX));
        }
}

std::vector<double> GltfDeformations::weights_of(const GltfNode& node) const {
    const std::size_t targets = gltf_target_count(document_, *node.json);
    if (targets == 0) return {};
    const auto posed = poses_.find(node.index);
    if (posed != poses_.end() && posed->second.weights) return *posed->second.weights;
    const Json& mesh = document_.element("meshes", *node.json, "mesh");
    const Json* given = &document_.list(*node.json, "weights");
    if (given->empty()) given = &document_.list(mesh, "weights");
    std::vector<double> weights = given->get<std::vector<double>>();
    if (weights.empty()) weights.assign(targets, 0);
    if (weights.size() != targets)
        document_.fail(
            fmt::format("node '{}' has {} weights for the {} morph targets of its mesh; export it "
                        "again",
                        name_or_number(*node.json, "node", node.index), weights.size(), targets));
    const bool is_still = !animated_.contains(node.index) &&
                          std::ranges::all_of(weights, [](double w) { return w == 0; });
    return is_still ? std::vector<double>() : weights;
}

std::vector<Affine> GltfDeformations::joints_of(const Json& skin, const std::string& name) const {
    const Json& joints = document_.list(skin, "joints");
    if (joints.empty()) document_.fail(fmt::format("skin '{}' has no joints", name));
    std::vector<float> inverse;
    if (skin.contains("inverseBindMatrices")) {
        const Json& accessor = document_.element("accessors", skin, "inverseBindMatrices");
        if (accessor.value("type", "") != "MAT4" ||
            document_.whole_number(accessor, "componentType", 0) != k_gltf_float ||
            document_.whole_number(accessor, "count", 0) < joints.size())
            document_.fail(
                fmt::format("skin '{}' does not have an inverse bind matrix of floats for each of "
                            "its {} joints; export the armature again",
                            name, joints.size()));
        inverse = bytes_.floats(accessor, 16);
        if (!std::ranges::all_of(inverse, [](float x) { return std::isfinite(x); }))
            document_.fail(fmt::format(
                "skin '{}' has inverse bind matrices that are not finite; export the armature "
                "again",
                name));
    }
    std::vector<Affine> file_from_bind;
    for (std::size_t k = 0; k < joints.size(); ++k) {
        const auto found = joints[k].is_number_unsigned()
                               ? file_from_node_.find(joints[k].get<std::size_t>())
                               : file_from_node_.end();
        if (found == file_from_node_.end())
            document_.fail(
                fmt::format("joint {} of skin '{}' is not a node of the file's scene; export the "
                            "armature with its mesh",
                            k, name));
        Affine joint_from_bind;
        if (!inverse.empty()) {
            const float* m = &inverse[16 * k];  // by columns; the last row is 0, 0, 0, 1
            joint_from_bind = {Matrix3(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]),
                               Vector3(m[12], m[13], m[14])};
        }
        file_from_bind.push_back(found->second * joint_from_bind);
    }
    return file_from_bind;
}

std::optional<GltfDeformation> GltfDeformations::of(const GltfNode& node) const {
    GltfDeformation deformation{weights_of(node), {}, {}};
    if (node.json->contains("skin")) {
        const Json& skin = document_.element("skins", *node.json, "skin");
        deformation.skin =
            name_or_number(skin, "skin", document_.whole_number(*node.json, "skin", 0));
        deformation.file_from_bind = joints_of(skin, deformation.skin);
    }
    if (deformation.weights.empty() && deformation.file_from_bind.empty()) return std::nullopt;
    return deformation;
}

void NormalisedWeights::report(const std::string& name, std::vector<std::string>& warnings) const {
    if (unweighted > 0)
        warnings.push_back(
            fmt::format("{}: {} vertices of skins have no weight; they follow the joint that they "
                        "name first",
                        name, unweighted));
    if (unbalanced > 0)
        warnings.push_back(
            fmt::format("{}: the weights of {} vertices of skins do not sum to 1; scaled to it",
                        name, unbalanced));
}

DeformedPrimitive::DeformedPrimitive(const GltfDocument& document, GltfBytes& bytes,
                                     const Json& primitive, const GltfDeformation& deformation,
                                     const Affine& file_from_mesh, const std::string& mesh_name)
    : document_(document),
      bytes_(bytes),
      primitive_(primitive),
      deformation_(deformation),
      file_from_mesh_(file_from_mesh) {
    if (!deformation_.file_from_bind.empty()) read_skin(mesh_name);
}

void DeformedPrimitive::read_skin(const std::string& mesh_name) {
    const Json& attributes = primitive_["attributes"];
    std::vector<std::vector<float>> joints, weights;
    for (int set = 0; set < k_max_joint_sets; ++set) {
        const std::string of_joints = fmt::format("JOINTS_{}", set),
                          of_weights = fmt::format("WEIGHTS_{}", set);
        if (!attributes.contains(of_joints) && !attributes.contains(of_weights)) break;
        if (!attributes.contains(of_joints) || !attributes.contains(of_weights))
            document_.fail(fmt::format("mesh '{}' has {} without {}; export it again", mesh_name,
                                       attributes.contains(of_joints) ? of_joints : of_weights,
                                       attributes.contains(of_joints) ? of_weights : of_joints));
        const auto values = [&](const std::string& semantic) {
            return bytes_.floats(document_.element("accessors", attributes, semantic.c_str()), 4);
        };
        joints.push_back(values(of_joints));
        weights.push_back(values(of_weights));
    }
    if (joints.empty()) return;  // the node's transform places it, as without a skin
    per_vertex_ = 4 * joints.size();
    const std::size_t vertices = joints[0].size() / 4;
    joints_.reserve(per_vertex_ * vertices);
    joint_weights_.reserve(per_vertex_ * vertices);
    for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
        throw_if_stopped();
        for (std::size_t set = 0; set < joints.size(); ++set)
            for (std::size_t k = 4 * vertex; k < 4 * vertex + 4; ++k) {
                joints_.push_back(static_cast<std::uint32_t>(joints[set][k]));
                joint_weights_.push_back(weights[set][k]);
            }
        normalise(vertex, mesh_name);
    }
}

void DeformedPrimitive::normalise(std::size_t vertex, const std::string& mesh_name) {
    const std::size_t first = per_vertex_ * vertex;
    double sum = 0;
    for (std::size_t k = first; k < first + per_vertex_; ++k) {
        if (!(joint_weights_[k] >= 0) || !std::isfinite(joint_weights_[k]))
            document_.fail(
                fmt::format("mesh '{}' has weights of joints that are negative or not finite; "
                            "normalise its weights and export it again",
                            mesh_name));
        sum += double{joint_weights_[k]};
        if (joint_weights_[k] > 0 && joints_[k] >= deformation_.file_from_bind.size())
            document_.fail(fmt::format(
                "mesh '{}' follows joint {} of skin '{}', which has {} joints; export "
                "the mesh and its armature together",
                mesh_name, joints_[k], deformation_.skin, deformation_.file_from_bind.size()));
    }
    if (sum > 0) {
        if (std::abs(sum - 1) > k_weight_tolerance) ++normalised_.unbalanced;
        for (std::size_t k = first; k < first + per_vertex_; ++k)
            joint_weights_[k] = static_cast<float>(double{joint_weights_[k]} / sum);
        return;
    }
    ++normalised_.unweighted;
    if (joints_[first] >= deformation_.file_from_bind.size()) joints_[first] = 0;
    joint_weights_[first] = 1;
}

Affine DeformedPrimitive::file_from(std::size_t vertex) const {
    if (!has_skin()) return file_from_mesh_;
    Matrix3 linear(0.0);
    Vector3 offset(0.0);
    double sum = 0;  // of the rounded weights, so that rounding does not scale the mesh
    for (std::size_t k = per_vertex_ * vertex; k < per_vertex_ * (vertex + 1); ++k) {
        if (joint_weights_[k] == 0) continue;
        const Affine& joint = deformation_.file_from_bind[joints_[k]];
        const double weight{joint_weights_[k]};
        linear += weight * joint.linear();
        offset += weight * joint.offset();
        sum += weight;
    }
    return {linear / sum, offset / sum};
}

std::vector<double> DeformedPrimitive::morphed(const char* semantic, std::size_t width) const {
    const std::vector<float> base =
        bytes_.floats(document_.element("accessors", primitive_["attributes"], semantic), width);
    std::vector<double> values(base.begin(), base.end());
    const Json& targets = document_.list(primitive_, "targets");
    for (std::size_t t = 0; t < std::min(targets.size(), deformation_.weights.size()); ++t) {
        const double weight = deformation_.weights[t];
        if (weight == 0 || !targets[t].contains(semantic)) continue;
        const std::vector<float> change =
            bytes_.floats(document_.element("accessors", targets[t], semantic), 3);
        for (std::size_t at = 0; at < change.size(); ++at)
            values[at / 3 * width + at % 3] += weight * double{change[at]};
    }
    return values;
}

std::vector<float> DeformedPrimitive::positions() const {
    const std::vector<double> values = morphed("POSITION", 3);
    std::vector<float> positions;
    positions.reserve(values.size());
    for (std::size_t at = 0; at < values.size(); at += 3) {
        throw_if_stopped();
        const Point3 p = file_from(at / 3) * Point3{values[at], values[at + 1], values[at + 2]};
        for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(p[axis]));
    }
    return positions;
}

std::vector<float> DeformedPrimitive::normals() const {
    const std::vector<double> values = morphed("NORMAL", 3);
    std::vector<float> normals;
    normals.reserve(values.size());
    for (std::size_t at = 0; at < values.size(); at += 3) {
        throw_if_stopped();
        const Vector3 n = unit_or_none(normal_map(file_from(at / 3).linear()) *
                                       Vector3(values[at], values[at + 1], values[at + 2]));
        for (int axis = 0; axis < 3; ++axis) normals.push_back(static_cast<float>(n[axis]));
    }
    return normals;
}

std::vector<float> DeformedPrimitive::tangents() const {
    const std::vector<double> values = morphed("TANGENT", 4);
    std::vector<float> tangents;
    tangents.reserve(values.size());
    for (std::size_t at = 0; at < values.size(); at += 4) {
        throw_if_stopped();
        const Affine map = file_from(at / 4);
        const Vector3 t =
            unit_or_none(map.linear() * Vector3(values[at], values[at + 1], values[at + 2]));
        for (int axis = 0; axis < 3; ++axis) tangents.push_back(static_cast<float>(t[axis]));
        // A mirroring map reverses cross products.
        tangents.push_back(
            static_cast<float>(map.determinant() < 0 ? -values[at + 3] : values[at + 3]));
    }
    return tangents;
}

}  // namespace uw
