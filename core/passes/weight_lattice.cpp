#include "core/passes/weight_lattice.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace uw {

namespace {

// The spacing of the rays of WeightLattice [pixels] leaves enough of them to show where particles
// begin, but stores no more than k_max_numbers weights for the whole image.
constexpr int k_max_spacing_of_weights = 4;
constexpr double k_min_rays = 8000;
constexpr double k_max_numbers = 1e7;
constexpr double k_pixel_centre = 0.5;  // offset of a pixel's centre from its corner [pixels]

}  // namespace

WeightLattice::WeightLattice(const RaySource& rays, const IntervalWeights& weights,
                             const PixelWindow& window)
    : uniform_(weights.of_uniform_water()) {
    if (!weights.vary()) return;
    const double pixels = static_cast<double>(rays.width()) * rays.height();
    const double numbers = pixels * static_cast<double>(uniform_.size());
    spacing_ = std::max(
        std::clamp(static_cast<int>(std::sqrt(pixels / k_min_rays)), 1, k_max_spacing_of_weights),
        static_cast<int>(std::ceil(std::sqrt(numbers / k_max_numbers))));
    column_ = window.x0 / spacing_;
    row_ = window.y0 / spacing_;
    const auto steps = [&](int first, int end) {
        return std::max(2, (end - 1 + spacing_ - 1) / spacing_ - first + 1);
    };
    const int columns = steps(column_, window.x1), rows = steps(row_, window.y1);
    rays_.assign(columns, rows);
    parallel_for(rays_.size(), [&](std::size_t at) {
        const int i = static_cast<int>(at) % columns, j = static_cast<int>(at) / columns;
        const auto ray =
            rays.refracted_ray(k_pixel_centre + (column_ + i) * static_cast<double>(spacing_),
                               k_pixel_centre + (row_ + j) * static_cast<double>(spacing_));
        if (ray)
            weights.find(*ray, rays_[at]);
        else
            rays_[at] = uniform_;
    });
}

void WeightLattice::find(double x, double y, std::vector<float>& weights) const {
    if (rays_.size() == 0) {
        weights = uniform_;
        return;
    }
    const double u = (x - k_pixel_centre) / spacing_ - column_,
                 v = (y - k_pixel_centre) / spacing_ - row_;
    const int i = std::clamp(static_cast<int>(u), 0, rays_.width() - 2);
    const int j = std::clamp(static_cast<int>(v), 0, rays_.height() - 2);
    weights.assign(uniform_.size(), 0.0F);
    const auto add = [&](int column, int row, double weight) {
        const std::vector<float>& corner = rays_(column, row);
        for (std::size_t k = 0; k < weights.size(); ++k)
            weights[k] += static_cast<float>(weight) * corner[k];
    };
    add(i, j, (1 - u + i) * (1 - v + j));
    add(i + 1, j, (u - i) * (1 - v + j));
    add(i, j + 1, (1 - u + i) * (v - j));
    add(i + 1, j + 1, (u - i) * (v - j));
}

}  // namespace uw
