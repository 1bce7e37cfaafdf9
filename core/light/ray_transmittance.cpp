#include "core/light/ray_transmittance.h"

#include <algorithm>
#include <cmath>

#include "core/base/numerics.h"

namespace uw {

AttenuationTable attenuation_of_constituents(const Medium& medium) {
    AttenuationTable table(medium);
    table.uniform = {};
    return table;
}

RayTransmittance::RayTransmittance(const AttenuationTable& attenuation,
                                   const ConcentrationField& field, const Ray& ray, double end)
    : attenuation_(attenuation) {
    field.profile(ray, end, profile_);
}

Spectrum RayTransmittance::optical_depth(std::size_t knot, double s) const {
    const auto count = static_cast<std::size_t>(profile_.constituent_count);
    const double begin = profile_.s[knot], t = s - begin;
    const double length = profile_.s[knot + 1] - begin;
    Spectrum depth;
    const auto bands = static_cast<std::size_t>(attenuation_.band_count);
    for (std::size_t b = 0; b < bands; ++b) depth[b] = attenuation_.uniform[b] * s;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = knot * count + k;
        const double first = profile_.concentration[at];
        const double change = profile_.concentration[at + count] - first;
        const double column =
            profile_.column[at] + t * (first + (length > 0 ? 0.5 * change * t / length : 0));
        for (std::size_t b = 0; b < bands; ++b)
            depth[b] += attenuation_.constituents[k][b] * column;
    }
    return depth;
}

double RayTransmittance::mean_transmittance(std::size_t knot, double s) const {
    const Spectrum depth = optical_depth(knot, s);
    double sum = 0;
    const auto bands = static_cast<std::size_t>(attenuation_.band_count);
    for (const double of_band : depth.first(bands)) sum += exp_of_minus(std::max(0.0, of_band));
    return sum / attenuation_.band_count;
}

Spectrum RayTransmittance::optical_depth(double s) const {
    const auto next = std::upper_bound(profile_.s.begin() + 1, profile_.s.end() - 1, s);
    return optical_depth(static_cast<std::size_t>(next - profile_.s.begin()) - 1, s);
}

double RayTransmittance::mean_transmittance(double s) const {
    const auto next = std::upper_bound(profile_.s.begin() + 1, profile_.s.end() - 1, s);
    return mean_transmittance(static_cast<std::size_t>(next - profile_.s.begin()) - 1, s);
}

std::optional<double> RayTransmittance::distance_at(double transmittance) const {
    // It falls monotonically, so that the first knot that has it ends the interval of the distance.
    std::size_t first = 0, last = profile_.s.size() - 1;
    if (mean_transmittance(last - 1, profile_.s[last]) > transmittance) return std::nullopt;
    while (last - first > 1) {
        const std::size_t middle = (first + last) / 2;
        (mean_transmittance(middle, profile_.s[middle]) > transmittance ? first : last) = middle;
    }
    double low = profile_.s[first], high = profile_.s[last];
    constexpr int k_bisections = 40;  // leaves 1e-12 of the interval
    for (int i = 0; i < k_bisections; ++i) {
        const double middle = 0.5 * (low + high);
        (mean_transmittance(first, middle) > transmittance ? low : high) = middle;
    }
    return high;
}

}  // namespace uw
