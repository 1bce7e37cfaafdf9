#include "core/forward/forward_images.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace uw {

PathScatter::PathScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane,
                         const Medium& medium, double spacing)
    : PathScatter(ForwardScatter(desc, plane, spacing), medium,
                  SplineLine::node_count(plane.width, spacing),
                  SplineLine::node_count(plane.height, spacing)) {}

PathScatter::PathScatter(ForwardScatter scatter, const Medium& medium, int width, int height)
    : scatter_(std::move(scatter)),
      attenuation_(medium),
      uniform_b_(medium.uniform.total_scattering()) {
    for (const Constituent& constituent : medium.constituents)
        constituent_b_.push_back(constituent.per_unit.total_scattering());
    if (constituent_b_.empty()) return;
    blur_length_.assign(width, height);
    optical_depth_.assign(width, height);
}

void PathScatter::add(std::size_t band, const ImagePlane& light, const PathImage& paths,
                      bool means) {
    const double c = attenuation_.uniform[band];
    if (constituent_b_.empty()) {
        scatter_.add({light.values(), paths.length().values(), {}, c}, means);
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
    scatter_.add({light.values(), blur_length_.values(), optical_depth_.values(), c}, means);
}

void check_blur_length(const Medium& medium, const SourceLocation& where) {
    if (medium.constituents.empty()) return;
    const Spectrum b = medium.uniform.total_scattering();
    for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band)
        if (!(b[band] > 0))
            throw InputError(
                fmt::format("{}: with volumes, the blur length is defined by the scattering of the "
                            "water itself, which is 0 at {:g} nm; give water.particles or "
                            "water.scattering, or K: 0",
                            where, medium.wavelengths_nm[band]));
}

}  // namespace uw
