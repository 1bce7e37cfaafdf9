#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/base/vector_math.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"
#include "core/scene/water_desc.h"

namespace uw {

/// Junge's hyperbolic size distribution: the number of particles with diameters from D to D + dD is
/// proportional to D^-exponent dD between a least and a greatest diameter (Junge 1963; Bader 1970;
/// of particles in the sea, exponents of 3 to 5). Diameters are those of spheres [m]. In all
/// functions least <= a < b <= greatest.
class JungeSizes {
  public:
    /// 0 < least < greatest.
    JungeSizes(double exponent, double least, double greatest);

    double least() const { return least_; }
    double greatest() const { return greatest_; }

    /// The share of all particles, by number, with diameters from `a` to `b`.
    double share(double a, double b) const;
    /// The diameter below which a share `u` of those from `a` to `b` is, 0 <= u <= 1.
    double quantile(double u, double a, double b) const;
    /// The mean cross section, pi D^2 / 4, of those from `a` to `b` [m^2].
    double mean_area(double a, double b) const;

  private:
    double exponent_, least_, greatest_;
};

/// One particle of snow.
struct SnowParticle {
    Point3 position;      // world, at the time asked for
    double diameter = 0;  // [m]
    std::uint64_t id =
        0;  // the same at all times; different for different particles, almost surely
};

/// Particles whose diameters lie within a factor of two.
struct SnowClass {
    double least = 0, greatest = 0;  // diameters [m]
    double number = 0;               // per m^3
    double mean_area = 0;            // cross section [m^2]
    double edge = 0;                 // of the cells that they are placed in [m]

    /// The share of light that they take away per metre: all that meets their cross section.
    double attenuation() const { return number * mean_area; }
};

/// The cell of a class with these indices: particles' positions at time 0 are from index * edge to
/// (index + 1) * edge along each axis.
using SnowCell = std::array<std::int64_t, 3>;

/// All the snow of an unbounded ocean. Nothing of it is stored: the particles of a cell, their
/// number (Poisson's), places (uniform) and diameters (Junge's) follow from the seed and the cell
/// alone, and all drift together, so that they are the same for every camera and frame.
class SnowField {
  public:
    explicit SnowField(const SnowDesc& desc);

    const std::vector<SnowClass>& classes() const { return classes_; }
    /// How far all particles have moved since time 0 [m].
    Vector3 displacement(double time) const { return time * drift_; }

    /// Appends the particles of a cell of class `index` at a time [s].
    void append_particles(std::size_t index, const SnowCell& cell, double time,
                          std::vector<SnowParticle>& particles) const;

  private:
    JungeSizes sizes_;
    std::vector<SnowClass> classes_;
    Vector3 drift_;
    std::uint64_t seed_;
};

/// The light that a white sphere with a diffuse surface scatters, as for the moon's phases: p =
/// 2/(3 pi^2) (sin psi - psi cos psi) (Lambert 1760; Schönberg 1929).
class LambertSphere final : public PhaseFunction {
  public:
    using PhaseFunction::evaluate;
    void evaluate(std::span<const double> psi, std::span<double> p) const override {
        for (std::size_t i = 0; i < psi.size(); ++i) p[i] = at(psi[i]);
    }
    std::string description() const override { return "diffuse spheres"; }

    static double at(double psi) {
        return 2 / (3 * std::numbers::pi * std::numbers::pi) *
               (std::sin(psi) - psi * std::cos(psi));
    }
};

/// The snow's own coefficients, as a mean over many particles: `attenuation` is their cross section
/// per volume [1/m], of which they scatter their reflectance as diffuse spheres do (LambertSphere).
struct SnowCoefficients {
    double attenuation = 0;
    Spectrum scattering{};
};
SnowCoefficients snow_coefficients(const SnowDesc& snow);

/// Adds the snow's coefficients to the uniform water of `medium`.
void add_snow(const SnowDesc& snow, Medium& medium);

/// `medium`, whose coefficients hold the snow, without the light that the snow scatters: with the
/// same attenuation. Throws InputError if it scatters more, in some direction and band, than the
/// uniform water does.
Medium without_snow(const SnowDesc& snow, const Medium& medium);

/// `medium`, whose coefficients hold the snow, but scattering only the light that the snow does:
/// with the same attenuation.
Medium snow_alone(const SnowDesc& snow, const Medium& medium);

/// Particles up to a distance are drawn one by one; those beyond are as many as their mean, which
/// this adds to the in-scatter of the water without snow.
class BeyondSnow final : public Integrator {
  public:
    /// A class of particles: drawn up to the distance `range` [m], with this share of the light
    /// that all snow scatters.
    struct Part {
        double range = 0, share = 0;
    };

    /// `water`: of the water without snow; `snow`: of snow alone (core/passes/marine_snow.h).
    BeyondSnow(std::unique_ptr<const Integrator> water, std::unique_ptr<const Integrator> snow,
               std::vector<Part> parts);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                         InScatter& result) const override;

  private:
    void add_beyond(const Ray& ray, double begin, std::span<const double> distances,
                    InScatter& result) const;

    std::unique_ptr<const Integrator> water_, snow_;
    std::vector<Part> parts_;  // by ascending range
};

/// The snow of a scene as one of its cameras sees it (docs/snow.md).
struct SnowModel {
    SnowField field;
    /// How far the particles of each class are drawn, along rays in water [m]; those beyond are as
    /// many as their mean.
    std::vector<double> ranges{};
    double expected_count = 0;  // of particles drawn, in the view
    Medium water;               // without the light that snow scatters
    Medium alone;               // that light alone
    std::optional<std::string> warning{};

    /// The optical depth of the particles drawn, as a mean over many, up to a distance [m]: the
    /// water's coefficients hold it, and so do the particles.
    double drawn_depth(double distance) const;
    /// For what lies beyond the ranges.
    std::vector<BeyondSnow::Part> parts() const;
};

}  // namespace uw
