#include "core/frame/weight_lattice.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace uw {

namespace {

constexpr int k_least_spacing = 4;
constexpr double k_most_numbers = 1e7;  // kept, for the whole image

}  // namespace

WeightLattice::WeightLattice(const RaySource& rays, const IntervalWeights& weights,
                             const PixelWindow& window)
    : uniform_(weights.of_uniform_water()) {
    if (!weights.vary()) return;
    const double numbers =
        static_cast<double>(rays.width()) * rays.height() * static_cast<double>(uniform_.size());
    spacing_ =
        std::max(k_least_spacing, static_cast<int>(std::ceil(std::sqrt(numbers / k_most_numbers))));
    column_ = window.x0 / spacing_;
    row_ = window.y0 / spacing_;
    const int columns = (window.x1 + spacing_ - 1) / spacing_ - column_ + 1;
    const int rows = (window.y1 + spacing_ - 1) / spacing_ - row_ + 1;
    rays_.assign(columns, rows);
    parallel_for(rays_.size(), [&](std::size_t at) {
        const int i = static_cast<int>(at) % columns, j = static_cast<int>(at) / columns;
        const auto ray = rays.refracted_ray((column_ + i) * static_cast<double>(spacing_),
                                            (row_ + j) * static_cast<double>(spacing_));
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
    const double u = x / spacing_ - column_, v = y / spacing_ - row_;
    const int i = std::clamp(static_cast<int>(u), 0, rays_.width() - 2);
    const int j = std::clamp(static_cast<int>(v), 0, rays_.height() - 2);
    weights.assign(uniform_.size(), 0.0F);
    const auto add = [&](int column, int row, double share) {
        const std::vector<float>& corner = rays_(column, row);
        for (std::size_t k = 0; k < weights.size(); ++k)
            weights[k] += static_cast<float>(share) * corner[k];
    };
    add(i, j, (1 - u + i) * (1 - v + j));
    add(i + 1, j, (u - i) * (1 - v + j));
    add(i, j + 1, (1 - u + i) * (v - j));
    add(i + 1, j + 1, (u - i) * (v - j));
}

}  // namespace uw
