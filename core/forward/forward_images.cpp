#include "core/forward/forward_images.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace uw {

namespace {

Spectrum scattering_of(const OpticalCoefficients& coefficients) {
    Spectrum b{};
    for (const Spectrum& part : coefficients.scattering)
        for (std::size_t band = 0; band < k_max_bands; ++band) b[band] += part[band];
    return b;
}

}  // namespace

PathScatter::PathScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane,
                         const Medium& medium)
    : scatter_(desc, plane), attenuation_(medium), uniform_b_(scattering_of(medium.uniform)) {
    for (const Constituent& constituent : medium.constituents)
        constituent_b_.push_back(scattering_of(constituent.per_unit));
    if (constituent_b_.empty()) return;
    const std::size_t pixels =
        static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height);
    blur_length_.resize(pixels);
    optical_depth_.resize(pixels);
}

void PathScatter::operator()(std::size_t band, const ImagePlane& light, const PathImage& paths,
                             ImagePlane& added) {
    const double c = attenuation_.uniform[band];
    if (constituent_b_.empty()) {
        scatter_.add({light, paths.length(), {}, c});
        scatter_.finish(added);
        return;
    }
    constexpr std::size_t k_block = 1 << 14;
    parallel_for((light.size() + k_block - 1) / k_block, [&](std::size_t block) {
        const std::size_t end = std::min(light.size(), (block + 1) * k_block);
        for (std::size_t i = block * k_block; i < end; ++i) {
            double blur = static_cast<double>(paths.length()[i]);
            double tau = c * blur;
            for (std::size_t k = 0; k < constituent_b_.size(); ++k) {
                const auto column = static_cast<double>(paths.column(k)[i]);
                blur += constituent_b_[k][band] / uniform_b_[band] * column;
                tau += attenuation_.constituents[k][band] * column;
            }
            blur_length_[i] = static_cast<float>(blur);
            optical_depth_[i] = static_cast<float>(tau);
        }
    });
    scatter_.add({light, blur_length_, optical_depth_, c});
    scatter_.finish(added);
}

void check_blur_length(const Medium& medium, const SourceLocation& where) {
    const Spectrum b = scattering_of(medium.uniform);
    for (int band = 0; band < medium.band_count() && medium.constituent_count() > 0; ++band)
        if (!(b[static_cast<std::size_t>(band)] > 0))
            throw InputError(
                fmt::format("{}: beside volumes the blur is measured by how much the water itself "
                            "scatters, and it does not at {:g} nm; give water.particles or "
                            "water.scattering, or K: 0",
                            where, medium.wavelengths_nm[static_cast<std::size_t>(band)]));
}

}  // namespace uw
