#include "core/light/sky_parts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace uw {

RectangleSums::RectangleSums(std::size_t rows, std::size_t columns,
                             const std::vector<double>& values)
    : stride_(columns + 1), sums_((rows + 1) * stride_, 0.0) {
    for (std::size_t row = 0; row < rows; ++row) {
        double of_row = 0;
        for (std::size_t column = 0; column < columns; ++column) {
            of_row += values[row * columns + column];
            sums_[(row + 1) * stride_ + column + 1] = sums_[row * stride_ + column + 1] + of_row;
        }
    }
}

namespace {

/// Halves a part again and again, across its longer side on the disc of the directions' sines,
/// until there are `count` of about equal weight.
class SkyDivision {
  public:
    SkyDivision(const RectangleSums& weights, const SkyQuadrature& lattice)
        : weights_(weights), edges_(lattice.row_sines), column_width_(lattice.column_width) {}

    void divide(const SkyRectangle& part, int count, std::vector<SkyRectangle>& parts) const {
        const bool is_single = part.row_end - part.row == 1 && part.column_end - part.column == 1;
        if (count == 1 || is_single) {
            parts.push_back(part);
            return;
        }
        const int first_count = count / 2;
        const auto [first, second] = halved(part, static_cast<double>(first_count) / count);
        divide(first, first_count, parts);
        divide(second, count - first_count, parts);
    }

  private:
    std::pair<SkyRectangle, SkyRectangle> halved(const SkyRectangle& part, double fraction) const {
        const double inner = edges_[part.row], outer = edges_[part.row_end];
        const double along = 0.5 * (inner + outer) * column_width_ *
                             static_cast<double>(part.column_end - part.column);
        const bool is_wide = part.column_end - part.column > 1 &&
                             (along > outer - inner || part.row_end - part.row == 1);
        SkyRectangle first = part, second = part;
        std::size_t& end = is_wide ? first.column_end : first.row_end;
        const std::size_t begin = is_wide ? part.column : part.row;
        const std::size_t last = end;
        const double wanted = fraction * weights_.of(part);
        // The boundary at which the weight of the first half is nearest to the one wanted.
        std::size_t best = begin + 1;
        double least = -1;
        for (std::size_t place = begin + 1; place < last; ++place) {
            end = place;
            const double off = std::abs(weights_.of(first) - wanted);
            if (least < 0 || off < least) {
                least = off;
                best = place;
            }
        }
        end = best;
        (is_wide ? second.column : second.row) = best;
        return {first, second};
    }

    const RectangleSums& weights_;
    std::span<const double> edges_;
    double column_width_;
};

// The cells of all parts together, unless there are more parts: enough for a blur of some degrees,
// and few enough to add them all up for each ray.
constexpr int k_cells_of_sky = 2048;

}  // namespace

SkyParts::SkyParts(const Sky& sky, int count, double water_index)
    : quadrature_(sky.quadrature()), index_(water_index) {
    const SkyQuadrature& q = *quadrature_;
    const std::size_t columns = q.column_count();
    // The plane irradiance below the surface, by which each node is normalised in each band.
    Spectrum below;
    for (const SkyQuadrature::Row& row : q.rows) {
        row_transmitted_.push_back(transmittance_into_water(row.cosine, index_) * row.cosine *
                                   row.solid_angle);
        row_cosines_.push_back(std::sqrt(1 - (1 - row.cosine * row.cosine) / (index_ * index_)));
    }
    for (std::size_t row = 0; row < q.rows.size(); ++row)
        for (std::size_t column = 0; column < columns; ++column)
            add_scaled(below.first(q.bands), row_transmitted_[row], q.radiance_at(row, column));
    std::vector<double> solid_angles;
    for (std::size_t row = 0; row < q.rows.size(); ++row)
        for (std::size_t column = 0; column < columns; ++column) {
            const std::span<const double> radiance = q.radiance_at(row, column);
            double weight = 0;
            for (std::size_t band = 0; band < q.bands; ++band)
                if (below[band] > 0) weight += radiance[band] / below[band];
            weights_.push_back(weight * row_transmitted_[row]);
            solid_angles.push_back(q.rows[row].solid_angle * q.rows[row].cosine /
                                   (index_ * index_ * row_cosines_[row]));
        }
    weight_sums_ = RectangleSums(q.rows.size(), columns, weights_);
    solid_angles_ = RectangleSums(q.rows.size(), columns, solid_angles);
    const SkyRectangle whole{0, q.rows.size(), 0, columns};
    cell_solid_angle_ = solid_angles_.of(whole) / k_cells_of_sky;
    std::vector<SkyRectangle> rectangles;
    SkyDivision(weight_sums_, q).divide(whole, count, rectangles);
    for (const SkyRectangle& rectangle : rectangles) add_part(rectangle);
}

Vector3 SkyParts::refracted(const Vector3& in_air) const {
    const double x = in_air.x / index_, y = in_air.y / index_;
    return {x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))};
}

void SkyParts::add_part(const SkyRectangle& rectangle) {
    const SkyQuadrature& q = *quadrature_;
    const std::size_t columns = q.column_count();
    Part part;
    part.lattice = rectangle;
    SkyDirection& direction = part.direction;
    Spectrum irradiance;
    double weight = 0, scalar = 0, east = 0, north = 0;
    for (std::size_t row = rectangle.row; row < rectangle.row_end; ++row)
        for (std::size_t column = rectangle.column; column < rectangle.column_end; ++column) {
            direction.solid_angle += q.rows[row].solid_angle;
            add_scaled(irradiance.first(q.bands), row_transmitted_[row],
                       q.radiance_at(row, column));
            const double node_weight = weights_[row * columns + column];
            const Vector3 towards = q.towards(row, column);
            weight += node_weight;
            scalar += node_weight / row_cosines_[row];
            east += node_weight * towards.x;
            north += node_weight * towards.y;
        }
    if (!(weight > 0)) return;
    // Clamped, since rounding must not carry it beyond the angles that light can have in water.
    const double steepest = 1, flattest = std::sqrt(1 - 1 / (index_ * index_));
    const double in_water = std::clamp(weight / scalar, flattest, steepest);
    const double sine = std::min(1.0, index_ * std::sqrt(std::max(0.0, 1 - in_water * in_water)));
    const double level = std::hypot(east, north);
    // Light that is symmetric about the zenith has no azimuth: a direction from above represents
    // it.
    const bool has_side = level > 1e-9 * weight;
    direction.towards = has_side ? Vector3{sine * east / level, sine * north / level,
                                           std::sqrt(std::max(0.0, 1 - sine * sine))}
                                 : Vector3{0, 0, 1};
    const double cosine = direction.towards.z;
    direction.radiance =
        irradiance / (transmittance_into_water(cosine, index_) * cosine * direction.solid_angle);
    part.in_water = refracted(direction.towards);
    double nearest = 1;  // cosine of the half angle
    for (std::size_t row = rectangle.row; row <= rectangle.row_end; ++row)
        for (std::size_t column = rectangle.column; column <= rectangle.column_end; ++column) {
            const double azimuth = q.first_azimuth + static_cast<double>(column) * q.column_width;
            const Vector3 corner =
                refracted({q.row_sines[row] * std::cos(azimuth),
                           q.row_sines[row] * std::sin(azimuth), q.row_cosines[row]});
            nearest = std::min(nearest, glm::dot(corner, part.in_water));
        }
    part.half_angle = std::acos(std::clamp(nearest, -1.0, 1.0));
    divide_into_cells(part);
    parts_.push_back(std::move(part));
}

void SkyParts::divide_into_cells(Part& part) const {
    const SkyQuadrature& q = *quadrature_;
    const std::size_t columns = q.column_count();
    const double count = solid_angles_.of(part.lattice) / cell_solid_angle_;
    std::vector<SkyRectangle> rectangles;
    SkyDivision(solid_angles_, q)
        .divide(part.lattice, std::max(1, static_cast<int>(std::lround(count))), rectangles);
    double all = 0;
    for (const SkyRectangle& rectangle : rectangles) {
        Vector3 towards(0);
        double scalar = 0, left = 0;
        for (std::size_t row = rectangle.row; row < rectangle.row_end; ++row)
            for (std::size_t column = rectangle.column; column < rectangle.column_end; ++column) {
                const double weight = weights_[row * columns + column] / row_cosines_[row];
                scalar += weight;
                left += weight *
                        std::exp(-k_depth_of_transmittance * part.in_water.z / row_cosines_[row]);
                towards += weight * refracted(q.towards(row, column));
            }
        if (!(scalar > 0)) continue;
        part.cells.push_back({glm::normalize(towards), scalar, left / scalar});
        all += scalar;
        part.mean += towards;
    }
    for (Cell& cell : part.cells) cell.weight /= all;
    part.mean /= all;
}

namespace {

// The last of the places from `begin` up to `end` before which `sum` is at most `target`.
template <class Sum>
std::size_t last_within(std::size_t begin, std::size_t end, double target, const Sum& sum) {
    while (end - begin > 1) {
        const std::size_t middle = begin + (end - begin) / 2;
        (sum(middle) <= target ? begin : end) = middle;
    }
    return begin;
}

}  // namespace

Vector3 SkyParts::sample(const Part& part, double u, double v) const {
    const SkyQuadrature& q = *quadrature_;
    const SkyRectangle& all = part.lattice;
    const auto rows_to = [&](std::size_t row) {
        return weight_sums_.of({all.row, row, all.column, all.column_end});
    };
    const double target = u * rows_to(all.row_end);
    const std::size_t row = last_within(all.row, all.row_end, target, rows_to);
    const auto columns_to = [&](std::size_t column) {
        return weight_sums_.of({row, row + 1, all.column, column});
    };
    const double of_row = columns_to(all.column_end), across = v * of_row;
    const std::size_t column = last_within(all.column, all.column_end, across, columns_to);
    const double of_cell = weight_sums_.of({row, row + 1, column, column + 1});
    const auto fraction = [](double part_of, double whole) {
        return whole > 0 ? std::clamp(part_of / whole, 0.0, 1.0) : 0.5;
    };
    const double down = fraction(target - rows_to(row), of_row);
    const double along = fraction(across - columns_to(column), of_cell);
    const double cosine = q.row_cosines[row] + down * (q.row_cosines[row + 1] - q.row_cosines[row]);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double azimuth = q.first_azimuth + (static_cast<double>(column) + along) * q.column_width;
    return refracted({sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
}

std::optional<SkyParts::Place> SkyParts::place_of(const Vector3& in_water) const {
    const SkyQuadrature& q = *quadrature_;
    const double square = index_ * index_ * (in_water.x * in_water.x + in_water.y * in_water.y);
    if (!(in_water.z > 0) || !(square < 1)) return std::nullopt;
    const double cosine = std::sqrt(1 - square);
    const auto row = static_cast<std::size_t>(
        std::ranges::upper_bound(q.row_cosines, cosine, std::greater<>{}) - q.row_cosines.begin());
    const double turns =
        (std::atan2(in_water.y, in_water.x) - q.first_azimuth) / (2 * std::numbers::pi);
    const auto columns = static_cast<double>(q.column_count());
    const auto column = static_cast<std::size_t>((turns - std::floor(turns)) * columns);
    return Place{std::clamp<std::size_t>(row, 1, q.rows.size()) - 1,
                 std::min(column, q.column_count() - 1), cosine, in_water.z};
}

double SkyParts::pdf(const Part& part, const Vector3& in_water) const {
    const std::optional<Place> place = place_of(in_water);
    const SkyRectangle& all = part.lattice;
    if (!place || place->row < all.row || place->row >= all.row_end || place->column < all.column ||
        place->column >= all.column_end)
        return 0;
    const SkyQuadrature& q = *quadrature_;
    const double fraction =
        weights_[place->row * q.column_count() + place->column] / weight_sums_.of(all);
    const double per_solid_angle_in_air = fraction / q.rows[place->row].solid_angle;
    return per_solid_angle_in_air * index_ * index_ * place->cosine / place->cosine_in_air;
}

Spectrum SkyParts::radiance(const Vector3& in_water) const {
    Spectrum radiance;
    const std::optional<Place> place = place_of(in_water);
    if (!place) return radiance;
    add_scaled(radiance.first(quadrature_->bands),
               index_ * index_ * transmittance_into_water(place->cosine_in_air, index_),
               quadrature_->radiance_at(place->row, place->column));
    return radiance;
}

std::vector<SkyDirection> Sky::directions(int count, double water_index) const {
    const SkyParts parts(*this, count, water_index);
    std::vector<SkyDirection> directions;
    for (const SkyParts::Part& part : parts.parts()) directions.push_back(part.direction);
    return directions;
}

}  // namespace uw
