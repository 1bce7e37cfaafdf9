#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "core/passes/forward_scatter.h"

/// Scenes and closed forms that tests of ForwardScatter share.
namespace uw::test::forward_scatter {

using Image = std::vector<float>;

inline constexpr double k_c = 0.4;      // 1/m
inline constexpr double k_focal = 400;  // pixels
inline const ForwardScatterDesc k_desc{
    .K = 1.5, .G = 0.1, .B = 0.01, .shape = ForwardScatterDesc::Shape::exponential};

inline ForwardScatterDesc with_shape(ForwardScatterDesc::Shape shape) {
    ForwardScatterDesc desc = k_desc;
    desc.shape = shape;
    return desc;
}

/// s of the kernel in pixels for a range of 1 m.
inline double width_per_metre(const ForwardScatterDesc& desc) {
    return k_focal * desc.B / (2 * std::numbers::pi);
}

inline double energy(const ForwardScatterDesc& desc, double range) {
    return desc.K * (std::exp(-desc.G * range) - std::exp(-k_c * range));
}

inline std::size_t pixels(const ScatterPlane& plane) {
    return static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height);
}

inline double sum(const Image& image) {
    double total = 0;
    for (const float value : image) total += static_cast<double>(value);
    return total;
}

/// Values between two bounds, most of them near the lower.
inline Image random_image(std::size_t size, double low, double high, unsigned seed) {
    std::mt19937 generator(seed);
    Image image(size);
    for (float& value : image) {
        const double unit = static_cast<double>(generator()) / 4294967296.0;
        value = static_cast<float>(low + (high - low) * unit * unit * unit);
    }
    return image;
}

inline Image scattered(const ForwardScatterDesc& desc, const ScatterPlane& plane,
                       const Image& light, const Image& range) {
    ForwardScatter scatter(desc, plane);
    scatter.add({light, range, {}, k_c});
    Image added(pixels(plane), -1.0F);
    scatter.finish(added);
    return added;
}

}  // namespace uw::test::forward_scatter
