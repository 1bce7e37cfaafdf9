#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/light/phase_function.h"
#include "core/light/strata.h"

namespace uw {

/// Inherent optical properties, absolute or per unit of concentration: a(lambda) and, for each
/// phase function m of the medium, its scattering coefficient b_m(lambda). [1/m], or [1/m per ppm],
/// or [1/m per unit of grid value].
struct OpticalCoefficients {
    Spectrum absorption{};
    std::vector<Spectrum> scattering;  // one per Medium::phase_functions

    /// c = a + sum_m b_m in band `band`.
    double attenuation(std::size_t band) const {
        double c = absorption[band];
        for (const Spectrum& b : scattering) c += b[band];
        return c;
    }
    /// The same for every band.
    Spectrum attenuation() const {
        Spectrum c = absorption;
        for (const Spectrum& b : scattering) c += b;
        return c;
    }
    /// sum_m b_m for every band.
    Spectrum total_scattering() const {
        Spectrum sum;
        for (const Spectrum& b : scattering) sum += b;
        return sum;
    }
};

/// A dissolved or suspended constituent whose concentration varies in space.
struct Constituent {
    std::string name;  // "small", "large", a species, or the name of a grid with its own optics
    std::string unit;  // "ppm" by volume, "sample" as measured, "1/m", or "1" for a bare grid value
    OpticalCoefficients per_unit;  // per unit of concentration
};

/// The optical properties of a scene's water. Every coefficient is linear in the concentrations
/// (physics section 1): X(x) = uniform.X + sum_k nu_k(x) constituents[k].per_unit.X.
struct Medium {
    std::vector<double> wavelengths_nm;  // the bands
    std::vector<std::shared_ptr<const PhaseFunction>> phase_functions;
    OpticalCoefficients uniform;            // water and everything else that is homogeneous
    std::vector<Constituent> constituents;  // contributed by the grids and by depth

    int band_count() const { return static_cast<int>(wavelengths_nm.size()); }
    int constituent_count() const { return static_cast<int>(constituents.size()); }
    int phase_count() const { return static_cast<int>(phase_functions.size()); }
};

/// The typical fraction of each phase function in the scattering of all that the water may contain,
/// as one distribution for all of it; they add up to 1, or are 0 where nothing scatters.
std::vector<double> typical_phase_fractions(const Medium& medium);

/// The concentration that one unit of a grid's value adds to a constituent of the water.
struct GridLoad {
    int constituent = 0;
    double per_unit = 0;  // in the constituent's unit, e.g. ppm

    friend bool operator==(const GridLoad&, const GridLoad&) = default;
};

/// Attenuation coefficients of a medium, laid out for the integrators' inner loops.
struct AttenuationTable {
    Spectrum uniform{};                  // c_0 [1/m]
    std::vector<Spectrum> constituents;  // c* per constituent [1/m per unit]
    int band_count = 0;

    explicit AttenuationTable(const Medium& medium);

    /// tau = c_0 length + sum_k N_k c*_k (physics section 1) for band `band`.
    double optical_depth(std::size_t band, double length, std::span<const double> columns) const {
        double tau = uniform[band] * length;
        for (std::size_t k = 0; k < constituents.size(); ++k)
            tau += constituents[k][band] * columns[k];
        return tau;
    }
    /// e^-tau of every band.
    Spectrum transmittance(double length, std::span<const double> columns) const;

    friend bool operator==(const AttenuationTable&, const AttenuationTable&) = default;
};

/// All phase functions of a medium, tabulated for the integrators' inner loop over h = tan(psi /
/// 2), which needs no trigonometry for points on a ray and whose logarithm resolves forward and
/// backward peaks equally well. Uses a parabola on each 64th of an octave: accurate to 1e-6, except
/// at the kinks of a tabulated phase function, where it is 2e-3 within one cell.
class PhaseTable {
  public:
    explicit PhaseTable(const Medium& medium);

    /// p_m of phase function m at each `half_tangent` >= 0 (infinity: psi = pi), into
    /// p[m * half_tangent.size() + i] [1/sr].
    void eval(std::span<const double> half_tangent, std::span<double> p) const;

    friend bool operator==(const PhaseTable&, const PhaseTable&) = default;

  private:
    std::size_t phases_;
    std::vector<double> coefficients_;  // [(cell * phases + m) * 3 + power]
};

/// The permitted error of columns, in terms of transmitted light: an error is measured as the
/// optical depth that it amounts to in the band that attenuates most, times an upper bound on the
/// transmittance of the path up to there. What lies behind a great optical depth, or varies little,
/// may thus be coarse.
class DepthTolerance {
  public:
    /// Permits no error: columns are as exact as voxels allow.
    DepthTolerance() = default;
    /// `optical_depth`: the greatest error of one step of an integration or interpolation.
    DepthTolerance(const Medium& medium, double optical_depth);

    bool exact() const { return optical_depth_ == 0; }

    /// Whether `error` [unit m], one per constituent, is within the tolerance behind the columns
    /// `before` and `length` metres of water.
    bool allows(std::span<const double> error, double length, std::span<const double> before) const;

    /// A lower bound on the optical depth of all bands.
    double min_depth(double length, std::span<const double> columns) const;

    friend bool operator==(const DepthTolerance&, const DepthTolerance&) = default;

  private:
    double optical_depth_ = 0;
    double min_uniform_ = 0;                           // over the bands [1/m]
    std::vector<double> min_per_unit_, max_per_unit_;  // per constituent [1/m per unit]
};

/// Concentrations along a ray for the integrators: values at ascending knots, linear in between,
/// and their cumulative integrals (columns).
struct ConcentrationProfile {
    int constituent_count = 0;
    std::vector<double> s;              // knot positions [m]; first 0, last the requested end
    std::vector<double> concentration;  // [knot * constituent_count + k], in the constituent's unit
    std::vector<double> column;         // int_0^s, same layout [unit m]

    bool empty_between(std::size_t knot) const {  // zero between knot and knot + 1
        for (int k = 0; k < constituent_count; ++k) {
            const std::size_t i =
                knot * static_cast<std::size_t>(constituent_count) + static_cast<std::size_t>(k);
            if (concentration[i] != 0 ||
                concentration[i + static_cast<std::size_t>(constituent_count)] != 0)
                return false;
        }
        return true;
    }
    /// Computes the columns, those of linear concentrations between the knots.
    void integrate();
};

/// Accumulates the derivatives of some number by the values of a field's voxels, from those by its
/// samples at points and its columns along paths: the transpose of ConcentrationField. For one
/// thread.
class FieldGradient {
  public:
    virtual ~FieldGradient() = default;
    /// The number changes by weights[k] per unit of constituent k at `x`.
    virtual void add_sample(const Point3& x, std::span<const double> weights) = 0;
    /// The number changes by weights[k] per unit of the column of constituent k from `a` to `b`.
    virtual void add_column(const Point3& a, const Point3& b, std::span<const double> weights) = 0;
};

/// Spatially varying concentrations of the medium's constituents, on top of the uniform water.
/// Thread safe.
class ConcentrationField {
  public:
    virtual ~ConcentrationField() = default;

    virtual int constituent_count() const = 0;
    /// The part that depends on depth alone; null if there is none.
    virtual std::shared_ptr<const Strata> strata() const { return nullptr; }
    /// The other part, which consists of voxels and has finite bounds.
    virtual const ConcentrationField& grids() const { return *this; }
    /// World bounds outside which every concentration is zero; empty if all are zero everywhere.
    virtual Bounds bounds() const = 0;
    /// Edge of the finest voxel [m]; 0 without voxels.
    virtual double finest_voxel() const = 0;

    /// Concentrations at `x` (world), one per constituent.
    virtual void sample(const Point3& x, std::span<double> concentration) const = 0;

    /// The exact integrals of the interpolated concentrations from `a` to `b` [unit m].
    virtual void column(const Point3& a, const Point3& b, std::span<double> column) const = 0;

    /// Concentrations along `ray` from 0 to `s_end`, with knots at the resolution of the voxels;
    /// `profile` is reused storage and is overwritten. Intervals without particles take two knots.
    virtual void profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const = 0;

    /// The same with one knot per voxel, for estimates by many rays: the columns' errors nearly
    /// cancel over rays in all directions, except at sharp edges.
    virtual void coarse_profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const {
        this->profile(ray, s_end, profile);
    }

    /// As profile(), with as few knots as `tolerance` permits.
    virtual void profile_within(const DepthTolerance& /*tolerance*/, const Ray& ray, double s_end,
                                ConcentrationProfile& profile) const {
        this->profile(ray, s_end, profile);
    }
};

}  // namespace uw
