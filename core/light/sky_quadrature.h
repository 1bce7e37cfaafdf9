#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/spectrum.h"
#include "core/base/vector_math.h"

namespace uw {

/// A lattice of directions towards the sky as a quadrature: rows of equal elevation, columns of
/// equal azimuth, and the radiance of each cell. Sky space (world_from_sky).
struct SkyQuadrature {
    struct Row {
        double cosine;       // of the angle from the zenith
        double solid_angle;  // of each of its columns [sr]

        double sine() const { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }
    };
    std::vector<Row> rows;            // from the zenith down
    std::vector<double> row_cosines;  // of the angles between rows, from 1 to 0: one more than rows
    std::vector<double> row_sines;    // of the same angles
    std::vector<double> column_sines, column_cosines;  // of azimuths, counterclockwise from east
    double first_azimuth = 0;                          // at which columns begin [rad]
    double column_width = 0;                           // [rad]
    std::size_t bands = 0;
    std::vector<double> radiance;  // scaled, row by row, column by column

    std::size_t column_count() const { return column_sines.size(); }
    Vector3 towards(std::size_t row, std::size_t column) const {
        const double sine = rows[row].sine();
        return {sine * column_cosines[column], sine * column_sines[column], rows[row].cosine};
    }
    std::span<const double> radiance_at(std::size_t row, std::size_t column) const {
        return std::span(radiance).subspan((row * column_count() + column) * bands, bands);
    }

    /// The lattice for a sky given by a function, without the radiance. `first`: the azimuth at
    /// which columns begin, that of the sun, so that they are symmetric about it.
    static SkyQuadrature even(double first);
    void set_columns(std::size_t count, double first);
    /// Sets where rows end, from their solid angles.
    void set_edges();
    /// Evaluates the sky everywhere.
    template <class Radiance>
    void fill(std::size_t band_count, const Radiance& of) {
        bands = band_count;
        radiance.clear();
        for (std::size_t row = 0; row < rows.size(); ++row)
            for (std::size_t column = 0; column < column_count(); ++column) {
                const Spectrum at = of(towards(row, column));
                radiance.insert(radiance.end(), at.begin(),
                                at.begin() + static_cast<std::ptrdiff_t>(bands));
            }
    }
    /// int f cos theta dOmega of a function of row and column.
    template <class Function>
    double irradiance(const Function& function) const {
        double sum = 0;
        for (std::size_t row = 0; row < rows.size(); ++row) {
            double of_row = 0;
            for (std::size_t column = 0; column < column_count(); ++column)
                of_row += function(row, column);
            sum += of_row * rows[row].cosine * rows[row].solid_angle;
        }
        return sum;
    }
    double irradiance_in(std::size_t band) const {
        return irradiance(
            [&](std::size_t row, std::size_t column) { return radiance_at(row, column)[band]; });
    }
};

}  // namespace uw
