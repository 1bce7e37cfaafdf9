#include "core/geometry/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/base/error.h"
#include "core/image/image_file.h"

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

namespace {

/// The texel to which `index`, which may lie outside the image, is wrapped.
int wrapped(double index, int size, TextureWrap wrap) {
    const double n = size;
    if (wrap == TextureWrap::clamp) return static_cast<int>(std::clamp(index, 0.0, n - 1));
    const double period = wrap == TextureWrap::repeat ? n : 2 * n;
    double within = index - period * std::floor(index / period);
    if (within >= period) within = 0;  // rounding of the floor above, for huge indices
    return static_cast<int>(within < n ? within : period - 1 - within);
}

}  // namespace

Texture::Texture(const PixelImage& image, TextureEncoding encoding, bool keep_alpha)
    : width_(image.width), height_(image.height) {
    if (width_ < 1 || height_ < 1 || image.channels < 1) {
        throw std::invalid_argument("a texture needs at least one pixel");
    }
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    rgb_.resize(3 * count);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        throw_if_stopped();
        for (std::size_t color = 0; color < 3; ++color) {
            const float encoded = image.pixels[pixel * channels + (channels < 3 ? 0 : color)];
            rgb_[3 * pixel + color] = encoding == TextureEncoding::linear || image.is_linear
                                          ? encoded
                                          : static_cast<float>(linear_from_srgb(encoded));
        }
    }
    if (!keep_alpha || (channels != 2 && channels != 4)) return;
    alpha_.resize(count);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        alpha_[pixel] = image.pixels[(pixel + 1) * channels - 1];
    }
}

Texture::Footprint Texture::footprint(double u, double v, const TextureLookup& lookup) const {
    const auto place = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    };
    const double x = u * width_, y = v * height_;
    if (lookup.filter == TextureFilter::nearest) {
        return {{place(wrapped(std::floor(x), width_, lookup.wrap_u),
                       wrapped(std::floor(y), height_, lookup.wrap_v))},
                {1.0},
                1};
    }
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const double fx = x - 0.5 - left, fy = y - 0.5 - top;
    const int x0 = wrapped(left, width_, lookup.wrap_u);
    const int x1 = wrapped(left + 1, width_, lookup.wrap_u);
    const int y0 = wrapped(top, height_, lookup.wrap_v);
    const int y1 = wrapped(top + 1, height_, lookup.wrap_v);
    return {{place(x0, y0), place(x1, y0), place(x0, y1), place(x1, y1)},
            {(1 - fy) * (1 - fx), (1 - fy) * fx, fy * (1 - fx), fy * fx},
            4};
}

Rgb Texture::sample(double u, double v, const TextureLookup& lookup) const {
    const Footprint around = footprint(u, v, lookup);
    Rgb result{};
    for (std::size_t k = 0; k < around.count; ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
            result[i] += around.weights[k] * rgb_[3 * around.texels[k] + i];
        }
    }
    return result;
}

double Texture::sample_alpha(double u, double v, const TextureLookup& lookup) const {
    if (alpha_.empty()) return 1;
    const Footprint around = footprint(u, v, lookup);
    double result = 0;
    for (std::size_t k = 0; k < around.count; ++k) {
        result += around.weights[k] * alpha_[around.texels[k]];
    }
    return result;
}

namespace {

Vector3 vector_at(const std::vector<float>& values, std::size_t at) {
    return {values[at], values[at + 1], values[at + 2]};
}

/// The angle of a triangle at its corner `k`.
double angle_at(const std::array<Vector3, 3>& points, std::size_t k) {
    const Vector3 a = points[(k + 1) % 3] - points[k], b = points[(k + 2) % 3] - points[k];
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
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
