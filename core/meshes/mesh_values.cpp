#include "core/meshes/mesh_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace uw {
namespace {

/// `value` within [low, high]; `low` if it is NaN. Notes in `odd` if that is another value.
template <class T>
void bring_within(T& value, double low, double high, bool& odd) {
    const auto was = static_cast<double>(value);
    if (was >= low && was <= high) return;
    value = static_cast<T>(was > low ? high : low);
    odd = true;
}

/// Calls `fix(values, odd)` for the `width` values of each vertex; how many of them were odd.
template <class Fix>
std::uint64_t count_odd(std::vector<float>& values, std::size_t width, const Fix& fix) {
    std::uint64_t count = 0;
    for (std::size_t at = 0; at + width <= values.size(); at += width) {
        bool odd = false;
        fix(std::span(values).subspan(at, width), odd);
        count += odd ? 1 : 0;
    }
    return count;
}

void bring_into_unit(std::span<float> values, bool& odd) {
    constexpr float k_rounding = 1e-4F;  // which needs no warning
    for (float& value : values) {
        if (value > 1 && value <= 1 + k_rounding) value = 1;
        bring_within(value, 0, 1, odd);
    }
}

bool is_beyond(double value, double limit) {
    return !(std::abs(value) <= limit);  // also NaN
}

void clamp_map(TextureUse& use, bool& odd) {
    const auto beyond = [](double value) { return is_beyond(value, k_max_uv); };
    if (std::ranges::none_of(use.transform, beyond)) return;
    use.transform = TextureUse().transform;
    odd = true;
}

void clamp_material(MeshMaterial& material, bool& odd) {
    for (double& part : material.emission) bring_within(part, 0, k_max_emission, odd);
    bring_within(material.normal_scale, -k_max_normal_scale, k_max_normal_scale, odd);
    for (TextureUse* use : {&material.base_map, &material.emission_map, &material.normal_map,
                            &material.metallic_roughness_map})
        clamp_map(*use, odd);
}

}  // namespace

void clamp_values(TriangleMesh& mesh, ClampedValues& clamped) {
    for (std::vector<float>& uvs : mesh.uvs)
        clamped.uvs += count_odd(uvs, 2, [](std::span<float> uv, bool& odd) {
            for (const float value : uv) odd |= is_beyond(static_cast<double>(value), k_max_uv);
            if (odd) std::ranges::fill(uv, 0.0F);
        });
    clamped.colors += count_odd(mesh.colors, 3, bring_into_unit);
    clamped.colors += count_odd(mesh.alphas, 1, bring_into_unit);
    count_odd(mesh.tangents, 4, [](std::span<float> tangent, bool&) {
        if (!std::ranges::all_of(tangent, [](float value) { return std::isfinite(value); }))
            std::ranges::fill(tangent, 0.0F);
    });
    for (MeshMaterial& material : mesh.materials) {
        bool odd = false;
        clamp_material(material, odd);
        clamped.materials += odd ? 1 : 0;
    }
}

void ClampedValues::report(const std::string& name, std::vector<std::string>& warnings) const {
    if (uvs > 0)
        warnings.push_back(
            fmt::format("{}: {} texture coordinates are not finite or beyond {:g}; taken as 0",
                        name, uvs, k_max_uv));
    if (colors > 0)
        warnings.push_back(
            fmt::format("{}: {} vertex colours are outside 0..1; clamped", name, colors));
    if (materials > 0)
        warnings.push_back(
            fmt::format("{}: {} materials have an emission beyond {:g}, a scale of a normal map "
                        "beyond {:g} or a transform of a texture beyond {:g}; clamped",
                        name, materials, k_max_emission, k_max_normal_scale, k_max_uv));
}

}  // namespace uw
