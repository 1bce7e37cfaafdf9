#include "core/geometry/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace uw {

namespace {

constexpr double k_red_nm = 620, k_green_nm = 540, k_blue_nm = 450;

Rgb weights_at(double wavelength_nm) {
    const double nm = std::clamp(wavelength_nm, k_blue_nm, k_red_nm);
    if (nm <= k_green_nm) {
        const double green = (nm - k_blue_nm) / (k_green_nm - k_blue_nm);
        return {0, green, 1 - green};
    }
    const double red = (nm - k_green_nm) / (k_red_nm - k_green_nm);
    return {red, 1 - red, 0};
}

}  // namespace

ReflectanceBands::ReflectanceBands(const std::vector<double>& wavelengths_nm) {
    if (wavelengths_nm.empty() || wavelengths_nm.size() > k_max_bands) {
        throw std::invalid_argument("reflectance needs 1 to 32 bands");
    }
    if (wavelengths_nm.size() == 3) {
        weights_ = {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}};
        return;
    }
    for (const double nm : wavelengths_nm) weights_.push_back(weights_at(nm));
}

Spectrum ReflectanceBands::from_rgb(const Rgb& rgb) const {
    Spectrum spectrum{};
    for (std::size_t band = 0; band < weights_.size(); ++band) {
        const Rgb& weight = weights_[band];
        spectrum[band] = weight[0] * rgb[0] + weight[1] * rgb[1] + weight[2] * rgb[2];
    }
    return spectrum;
}

Rgb ReflectanceBands::by_rgb(std::span<const double> by_band) const {
    Rgb rgb{};
    for (std::size_t band = 0; band < weights_.size(); ++band)
        for (std::size_t color = 0; color < 3; ++color)
            rgb[color] += weights_[band][color] * by_band[band];
    return rgb;
}

namespace {

Vector3 vector_at(const std::vector<float>& values, std::size_t at) {
    return {values[at], values[at + 1], values[at + 2]};
}

/// The angle of a triangle at its corner `k`.
double angle_at(const std::array<Vector3, 3>& points, std::size_t k) {
    const Vector3 a = points[(k + 1) % 3] - points[k], b = points[(k + 2) % 3] - points[k];
    return angle_between(a, b);
}

struct Sums {
    Vector3 tangent{0.0};
    double side = 0;
};

}  // namespace

bool uv_axes(const TriangleMesh& mesh, const std::uint32_t* corners, const TextureUse& use,
             UvAxes& axes) {
    const std::vector<float>& uvs = mesh.uvs[use.uv_set];
    std::array<Vector3, 3> p{};
    std::array<double, 3> u{}, v{};
    for (std::size_t k = 0; k < 3; ++k) {
        p[k] = vector_at(mesh.positions, 3 * std::size_t{corners[k]});
        const double raw_u = uvs[2 * std::size_t{corners[k]}];
        const double raw_v = uvs[2 * std::size_t{corners[k]} + 1];
        const auto& m = use.transform;
        u[k] = m[0] * raw_u + m[1] * raw_v + m[2];
        v[k] = m[3] * raw_u + m[4] * raw_v + m[5];
    }
    const Vector3 e1 = p[1] - p[0], e2 = p[2] - p[0];
    const double du1 = u[1] - u[0], du2 = u[2] - u[0], dv1 = v[1] - v[0], dv2 = v[2] - v[0];
    const double area = du1 * dv2 - du2 * dv1;
    if (!(std::abs(area) > 0) || !std::isfinite(area)) return false;
    axes.u_axis = (dv2 * e1 - dv1 * e2) / area;
    axes.up_axis = (du2 * e1 - du1 * e2) / area;
    return glm::length(axes.u_axis) > 0 && glm::length(axes.up_axis) > 0;
}

void compute_tangents(TriangleMesh& mesh) {
    if (mesh.tangents.empty() || mesh.normals.empty()) return;
    std::vector<Sums> sums(mesh.vertex_count());
    for (std::size_t triangle = 0; triangle < mesh.triangle_count(); ++triangle) {
        const std::size_t index =
            mesh.triangle_materials.empty() ? 0 : mesh.triangle_materials[triangle];
        const TextureUse& use = mesh.materials[index].normal_map;
        const std::uint32_t* corners = &mesh.triangles[3 * triangle];
        UvAxes axes;
        if (!use || !uv_axes(mesh, corners, use, axes)) continue;
        std::array<Vector3, 3> points{};
        for (std::size_t k = 0; k < 3; ++k) {
            points[k] = vector_at(mesh.positions, 3 * std::size_t{corners[k]});
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3 normal = vector_at(mesh.normals, 3 * std::size_t{corners[k]});
            const Vector3 across = axes.u_axis - glm::dot(axes.u_axis, normal) * normal;
            const double length = glm::length(across), angle = angle_at(points, k);
            if (!(length > 0)) continue;
            sums[corners[k]].tangent += angle / length * across;
            const double side = glm::dot(glm::cross(normal, axes.u_axis), axes.up_axis);
            sums[corners[k]].side += side < 0 ? -angle : angle;
        }
    }
    for (std::size_t vertex = 0; vertex < sums.size(); ++vertex) {
        float* tangent = &mesh.tangents[4 * vertex];
        const bool is_given = std::any_of(tangent, tangent + 3, [](float x) { return x != 0; });
        const double length = glm::length(sums[vertex].tangent);
        if (is_given || !(length > 1e-9)) continue;
        for (int axis = 0; axis < 3; ++axis) {
            tangent[axis] = static_cast<float>(sums[vertex].tangent[axis] / length);
        }
        tangent[3] = sums[vertex].side < 0 ? -1.0F : 1.0F;
    }
}

}  // namespace uw
