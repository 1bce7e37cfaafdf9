#include "core/light/emission.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/image/spectral_bands.h"

namespace uw {

namespace {

constexpr double k_coldest = 500, k_hottest = 1e5;     // [K]
constexpr int k_temperatures = 1024;                   // ln B is nearly linear in 1/T
constexpr double k_stefan_boltzmann = 5.670374419e-8;  // [W/(m^2 K^4)]

// The log radiance of a blackbody per band [W/(sr m^2)], at equal steps of 1/T from the hottest to
// the coldest.
std::vector<Spectrum> log_radiance(std::span<const double> bands_nm) {
    const std::vector<BandInterval> intervals = band_intervals(bands_nm);
    std::vector<Spectrum> result;
    for (int i = 0; i <= k_temperatures; ++i) {
        const double inverse = 1 / k_hottest + (1 / k_coldest - 1 / k_hottest) * i / k_temperatures;
        LampSpectrumDesc desc;
        desc.type = LampSpectrumDesc::Type::blackbody;
        desc.temperature = 1 / inverse;
        const PerBand bands =
            band_values(make_lamp_spectrum(desc),
                        k_stefan_boltzmann * std::pow(inverse, -4) / std::numbers::pi, intervals);
        result.push_back(per_band(
            bands.size(), [&](std::size_t b) { return std::log(std::max(bands[b], 1e-300)); }));
    }
    return result;
}

}  // namespace

Emission::Emission(const EmissionDesc& desc, std::span<const double> bands_nm)
    : bands_(bands_nm.size()), blackbody_(desc.blackbody) {
    std::ranges::copy(desc.per_unit, per_unit_.begin());
    for (const EmissionDesc::Row& row : desc.table) {
        values_.push_back(row.value);
        std::ranges::copy(row.light, light_.emplace_back().begin());
    }
    if (!blackbody_) return;
    if (bands_nm.size() < 2)
        throw InputError(
            fmt::format("{}: how much of a blackbody's light falls into a single band is "
                        "undefined, as it has no neighbours; give per_unit in that band",
                        desc.where));
    log_radiance_ = log_radiance(bands_nm);
}

Spectrum Emission::of(double value) const {
    if (!values_.empty()) {
        if (value < values_.front()) return {};
        const auto above =
            static_cast<std::size_t>(std::ranges::upper_bound(values_, value) - values_.begin());
        if (above == values_.size()) return light_.back();
        const double t = (value - values_[above - 1]) / (values_[above] - values_[above - 1]);
        return (1 - t) * light_[above - 1] + t * light_[above];
    }
    if (!blackbody_) return value * per_unit_;
    const double temperature = value * blackbody_->kelvin + blackbody_->offset;
    if (value <= 0 || temperature < k_coldest) return {};
    const double place = (1 / std::min(temperature, k_hottest) - 1 / k_hottest) /
                         (1 / k_coldest - 1 / k_hottest) * k_temperatures;
    const auto below =
        static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(k_temperatures - 1)));
    const double t = place - static_cast<double>(below);
    const Spectrum &a = log_radiance_[below], &b = log_radiance_[below + 1];
    return per_band(bands_, [&](std::size_t band) {
        return per_unit_[band] * std::exp(a[band] + t * (b[band] - a[band]));
    });
}

namespace {

constexpr int k_max_cells = 1 << 21;
// The mean square distance of a sphere's light from its centre, in squares of the radius: that of a
// density 1/sqrt(1 - r^2) (LampFrame).
constexpr double k_mean_square = 0.75;

struct EmissiveCell {
    Point3 centre;
    double weight = 0;  // of all bands [W/sr]
    double square = 0;  // mean square distance of its light from its centre [m^2]
    Spectrum intensity;
};

std::vector<EmissiveCell> cells_of(const ConcentrationField& field, const Emission& emission) {
    std::vector<EmissiveCell> cells;
    const Bounds bounds = field.bounds();
    if (bounds.empty()) return cells;
    const Vector3 size = bounds.max - bounds.min;
    const double edge =
        std::max(field.finest_voxel(), std::cbrt(size.x * size.y * size.z / k_max_cells));
    std::array<int, 3> count{};
    Vector3 cell;
    for (int axis = 0; axis < 3; ++axis) {
        count[static_cast<std::size_t>(axis)] =
            std::max(1, static_cast<int>(std::ceil(size[axis] / edge - 1e-6)));
        cell[axis] = size[axis] / count[static_cast<std::size_t>(axis)];
    }
    const double volume = cell.x * cell.y * cell.z;
    for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j) {
            throw_if_stopped();
            for (int i = 0; i < count[0]; ++i) {
                const Point3 x = bounds.min + Vector3(i + 0.5, j + 0.5, k + 0.5) * cell;
                double value = 0;
                field.sample(x, std::span(&value, 1));
                if (value <= 0) continue;
                EmissiveCell lit{x, 0, glm::dot(cell, cell) / 12, volume * emission.of(value)};
                for (const double band : lit.intensity) lit.weight += band;
                if (lit.weight > 0) cells.push_back(lit);
            }
        }
    return cells;
}

EmissivePart part_of(std::span<const EmissiveCell> cells) {
    EmissivePart part;
    double weight = 0, square = 0;
    Vector3 mean(0);
    for (const EmissiveCell& cell : cells) {
        part.intensity += cell.intensity;
        weight += cell.weight;
        mean += cell.weight * from_origin(cell.centre);
    }
    mean /= weight;
    part.centre = at_origin_plus(mean);
    for (const EmissiveCell& cell : cells) {
        const Vector3 offset = cell.centre - part.centre;
        square += cell.weight * (glm::dot(offset, offset) + cell.square);
    }
    part.radius = std::sqrt(square / (weight * k_mean_square));
    return part;
}

// The axis along which the cells' light has the greatest variance.
int widest_axis(std::span<const EmissiveCell> cells) {
    double weight = 0;
    Vector3 mean(0), square(0);
    for (const EmissiveCell& cell : cells) {
        const Vector3 x = cell.centre - cells.front().centre;
        weight += cell.weight;
        mean += cell.weight * x;
        square += cell.weight * x * x;
    }
    const Vector3 spread = square / weight - (mean / weight) * (mean / weight);
    if (spread.x >= spread.y && spread.x >= spread.z) return 0;
    return spread.y >= spread.z ? 1 : 2;
}

// Bisects the cells recursively into halves of equal power.
void divide(std::span<EmissiveCell> cells, int count, std::vector<EmissivePart>& parts) {
    if (count == 1 || cells.size() == 1) {
        parts.push_back(part_of(cells));
        return;
    }
    const int axis = widest_axis(cells);
    std::ranges::sort(cells, {},
                      [&](const EmissiveCell& cell) { return from_origin(cell.centre)[axis]; });
    double all = 0, sum = 0;
    for (const EmissiveCell& cell : cells) all += cell.weight;
    const int half = count / 2;
    const double wanted = all * half / count;
    std::size_t end = 0;
    while (end + 1 < cells.size() && sum + 0.5 * cells[end].weight < wanted)
        sum += cells[end++].weight;
    end = std::max(end, std::size_t{1});
    divide(cells.first(end), half, parts);
    divide(cells.subspan(end), count - half, parts);
}

}  // namespace

std::vector<EmissivePart> divide_emission(const ConcentrationField& field, const Emission& emission,
                                          int count) {
    std::vector<EmissiveCell> cells = cells_of(field, emission);
    std::vector<EmissivePart> parts;
    if (!cells.empty()) divide(cells, count, parts);
    return parts;
}

std::vector<EmissivePart> merged(std::span<const EmissivePart> parts, int count) {
    std::vector<EmissivePart> result;
    std::vector<EmissiveCell> cells;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        EmissiveCell cell{parts[i].centre, 0, k_mean_square * parts[i].radius * parts[i].radius,
                          parts[i].intensity};
        for (const double band : cell.intensity) cell.weight += band;
        cells.push_back(cell);
        if (cells.size() < static_cast<std::size_t>(count) && i + 1 < parts.size()) continue;
        result.push_back(part_of(cells));
        cells.clear();
    }
    return result;
}

}  // namespace uw
