#include "core/meshes/gltf/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/motion/knots.h"
#include "core/motion/rotation_spline.h"

namespace uw {
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
        if (interpolation_ == "STEP") return span.share < 1 ? a : b;
        if (per_key_ == 3) return cubic(span, a, key(span.first, 2), key(span.first + 1, 0), b);
        if constexpr (N == 4) {
            const Rotation turn = turned(rotation(a), rotation(b), span.share);
            return {turn.x, turn.y, turn.z, turn.w};
        } else {
            Value value{};
            for (std::size_t i = 0; i < N; ++i) value[i] = a[i] + span.share * (b[i] - a[i]);
            return value;
        }
    }

  private:
    /// Of a cubic spline part 0 is the tangent in, 1 the value, 2 the tangent out.
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
        const double t = span.share, t2 = t * t, t3 = t2 * t;
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

}  // namespace uw
