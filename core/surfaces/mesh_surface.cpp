#include "core/surfaces/mesh_surface.h"

#include <algorithm>
#include <cmath>

#include "core/meshes/mesh_tangents.h"

namespace uw {

MeshPlace::MeshPlace(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v)
    : mesh_(&mesh),
      material_(
          &mesh.materials[mesh.triangle_materials.empty() ? 0 : mesh.triangle_materials[triangle]]),
      corners_(&mesh.triangles[3 * std::size_t{triangle}]) {
    const double b = std::clamp(u, 0.0, 1.0), c = std::clamp(v, 0.0, 1.0 - b);
    weights_ = {1 - b - c, b, c};
}

double MeshPlace::mean(const std::vector<float>& values, std::size_t width,
                       std::size_t component) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        sum += weights_[k] * values[width * std::size_t{corners_[k]} + component];
    }
    return sum;
}

Vector3 MeshPlace::mean_vector(const std::vector<float>& values, std::size_t width) const {
    return {mean(values, width, 0), mean(values, width, 1), mean(values, width, 2)};
}

Rgb MeshPlace::sample(const TextureUse& use) const {
    const std::vector<float>& uvs = mesh_->uvs[use.uv_set];
    return use.sample(mean(uvs, 2, 0), mean(uvs, 2, 1));
}

Rgb MeshPlace::base_color() const {
    Rgb color = material_->base_color;
    if (material_->base_map) {
        const Rgb texel = sample(material_->base_map);
        for (std::size_t i = 0; i < 3; ++i) color[i] *= texel[i];
    }
    if (!mesh_->colors.empty()) {
        for (std::size_t i = 0; i < 3; ++i) color[i] *= mean(mesh_->colors, 3, i);
    }
    return color;
}

bool MeshPlace::is_hole() const {
    if (material_->alpha_cutoff <= 0) return false;
    double alpha = material_->alpha;
    if (const TextureUse& use = material_->base_map) {
        const std::vector<float>& uvs = mesh_->uvs[use.uv_set];
        alpha *= use.sample_alpha(mean(uvs, 2, 0), mean(uvs, 2, 1));
    }
    if (!mesh_->alphas.empty()) alpha *= mean(mesh_->alphas, 1, 0);
    return alpha < material_->alpha_cutoff;
}

Rgb MeshPlace::emission() const {
    Rgb radiance = material_->emission;
    if (material_->emission_map) {
        const Rgb texel = sample(material_->emission_map);
        for (std::size_t i = 0; i < 3; ++i) radiance[i] *= texel[i];
    }
    return radiance;
}

std::array<double, 2> MeshPlace::roughness_metallic() const {
    std::array<double, 2> result{material_->roughness, material_->metallic};
    if (material_->metallic_roughness_map) {
        const Rgb texel = sample(material_->metallic_roughness_map);
        result[0] *= texel[1];
        result[1] *= texel[2];
    }
    return result;
}

std::optional<Vector3> MeshPlace::interpolated_normal() const {
    if (mesh_->normals.empty()) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) {
        const float* n = &mesh_->normals[3 * std::size_t{corners_[k]}];
        if (n[0] == 0 && n[1] == 0 && n[2] == 0) return std::nullopt;
    }
    const Vector3 sum = mean_vector(mesh_->normals, 3);
    const double length = glm::length(sum);
    if (!(length > 1e-6)) return std::nullopt;
    return sum / length;
}

Vector3 MeshPlace::turn_side(const Vector3& flat) const {
    std::array<Vector3, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) {
        const float* at = &mesh_->positions[3 * std::size_t{corners_[k]}];
        p[k] = Vector3(at[0], at[1], at[2]);
    }
    return glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), flat) < 0 ? -flat : flat;
}

Vector3 MeshPlace::bent(const Vector3& normal) const {
    const TextureUse& use = material_->normal_map;
    const Rgb texel = sample(use);
    const double scale = material_->normal_scale;
    const Vector3 local(scale * (2 * texel[0] - 1), scale * (2 * texel[1] - 1), 2 * texel[2] - 1);
    Vector3 tangent(0.0), up(0.0);
    double side = 1;
    const bool has_all = !mesh_->tangents.empty() && [&] {
        for (std::size_t k = 0; k < 3; ++k) {
            const float* t = &mesh_->tangents[4 * std::size_t{corners_[k]}];
            if (t[0] == 0 && t[1] == 0 && t[2] == 0) return false;
        }
        return true;
    }();
    if (has_all) {
        tangent = mean_vector(mesh_->tangents, 4);
        side = mean(mesh_->tangents, 4, 3) < 0 ? -1 : 1;
    } else {
        UvAxes axes;
        if (!uv_axes(*mesh_, corners_, use, axes)) return normal;
        tangent = axes.u_axis;
        side = glm::dot(glm::cross(normal, tangent), axes.up_axis) < 0 ? -1 : 1;
    }
    tangent -= glm::dot(tangent, normal) * normal;
    const double length = glm::length(tangent);
    if (!(length > 0) || !std::isfinite(length)) return normal;
    tangent /= length;
    up = side * glm::cross(normal, tangent);
    const Vector3 result = local.x * tangent + local.y * up + local.z * normal;
    const double size = glm::length(result);
    return size > 1e-6 && local.z > 0 ? result / size : normal;
}

Vector3 MeshPlace::shading_normal(const Vector3& flat) const {
    const std::optional<Vector3> interpolated = interpolated_normal();
    if (!material_->normal_map) {
        if (!interpolated) return flat;
        return glm::dot(*interpolated, flat) < 0 ? -*interpolated : *interpolated;
    }
    // The map is defined for the front: the side of the file's normals, or that of the winding
    // order.
    const Vector3 front = interpolated ? *interpolated : turn_side(flat);
    // Seen from behind, bumps appear as dents.
    Vector3 normal = glm::dot(front, flat) < 0 ? -bent(front) : bent(front);
    const double toward = glm::dot(normal, flat);
    if (toward < 0) normal = glm::normalize(normal - toward * flat);
    return normal;
}

}  // namespace uw
