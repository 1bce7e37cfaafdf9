#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/spectrum.h"
#include "core/base/vector_math.h"
#include "core/light/sky.h"
#include "core/light/sky_quadrature.h"

namespace uw {

/// Some neighbouring rows and columns of a sky's lattice.
struct SkyRectangle {
    std::size_t row, row_end, column, column_end;
};

/// Sums of a table of values over any rectangle of it.
class RectangleSums {
  public:
    RectangleSums() = default;
    RectangleSums(std::size_t rows, std::size_t columns, const std::vector<double>& values);

    double of(const SkyRectangle& part) const {
        return at(part.row_end, part.column_end) - at(part.row, part.column_end) -
               at(part.row_end, part.column) + at(part.row, part.column);
    }

  private:
    double at(std::size_t row, std::size_t column) const { return sums_[row * stride_ + column]; }

    std::size_t stride_ = 0;
    std::vector<double> sums_;
};

/// The light of a sky in calm water, divided into parts of about equal irradiance: what
/// Sky::directions stands for. Parts are sampled, and divided further into cells for averages over
/// them. Directions lead from the water towards the sky; they are unit, in sky space. The radiance
/// is that of the sky's lattice. Immutable.
class SkyParts {
  public:
    /// The optical depth for which the mean attenuation of a part's light is exact. Less is off by
    /// less light, and at greater ones most light has been scattered before.
    static constexpr double k_depth_of_transmittance = 2;

    /// A direction that stands for a small part of the sky, within one of the parts.
    struct Cell {
        Vector3 towards;  // in the water
        double weight;    // its fraction of the part's scalar irradiance, mean over the bands
        /// e^-d of its light at a depth that light of the part's direction reaches with the optical
        /// depth d = k_depth_of_transmittance.
        double transmittance;
    };
    struct Part {
        SkyDirection direction;  // that represents it, in the air
        Vector3 in_water;        // the same
        Vector3 mean{0};         // of all its directions in the water, weighted as cells are
        double half_angle = 0;   // no direction of the part is farther from it in the water [rad]
        std::vector<Cell> cells;
        SkyRectangle lattice;
    };

    /// Divides the light of `sky` as Sky::directions says.
    SkyParts(const Sky& sky, int count, double water_index);

    std::span<const Part> parts() const { return parts_; }
    /// The mean solid angle of a cell in the water [sr].
    double cell_solid_angle() const { return cell_solid_angle_; }

    /// Samples a direction in the water within a part by two numbers in [0, 1), in proportion to
    /// the irradiance on the water, mean over the bands.
    Vector3 sample(const Part& part, double u, double v) const;
    /// The pdf of that per solid angle in the water [1/sr]; 0 outside of the part.
    double pdf(const Part& part, const Vector3& in_water) const;
    /// The radiance in the water from a direction there, below the surface [W m^-2 sr^-1]; none
    /// beyond Snell's window.
    Spectrum radiance(const Vector3& in_water) const;

  private:
    struct Place {
        std::size_t row, column;
        double cosine_in_air, cosine;  // of the angles from the zenith
    };
    // The cell of the lattice that is seen in a direction in the water.
    std::optional<Place> place_of(const Vector3& in_water) const;
    Vector3 refracted(const Vector3& in_air) const;
    void add_part(const SkyRectangle& rectangle);
    void divide_into_cells(Part& part) const;

    std::shared_ptr<const SkyQuadrature> quadrature_;
    double index_;
    // By cell of the lattice, and what its irradiance below the surface is, over that of all and
    // summed over the bands:
    std::vector<double> weights_;
    std::vector<double> row_transmitted_;       // T cos theta dOmega by row
    std::vector<double> row_cosines_;           // in the water
    RectangleSums weight_sums_, solid_angles_;  // the latter in the water
    double cell_solid_angle_ = 0;
    std::vector<Part> parts_;
};

}  // namespace uw
