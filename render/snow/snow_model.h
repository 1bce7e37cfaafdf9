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

#include "camera/camera.h"
#include "core/base/vector_math.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"
#include "core/scene/water_desc.h"

namespace uw {

/// Junge's hyperbolic size distribution: the number of particles with diameters from D to D + dD is
/// proportional to D^-exponent dD between a least and a greatest diameter (Junge 1963; Bader 1970).
/// In the sea, exponents are 3 to 5. Diameters are those of spheres [m]. All functions require
/// least <= a < b <= greatest.
class JungeSizes {
  public:
    /// Precondition: 0 < least < greatest.
    JungeSizes(double exponent, double least, double greatest);

    double least() const { return least_; }
    double greatest() const { return greatest_; }

    /// Returns the fraction of all particles, by number, with diameters from `a` to `b`.
    double fraction(double a, double b) const;
    /// Returns the diameter below which a fraction `u` of the particles from `a` to `b` lies, 0 <=
    /// u <= 1.
    double quantile(double u, double a, double b) const;
    /// Returns the mean cross section, pi D^2 / 4, of the particles from `a` to `b` [m^2].
    double mean_area(double a, double b) const;

  private:
    double exponent_, least_, greatest_;
};

/// One particle of snow.
struct SnowParticle {
    Point3 position;      // in world space, at the requested time
    double diameter = 0;  // [m]
    /// The same at all times; different for different particles, almost surely.
    std::uint64_t id = 0;
};

/// Particles whose diameters lie within a factor of two.
struct SnowClass {
    double least = 0, greatest = 0;  // diameters [m]
    double number = 0;               // per m^3
    double mean_area = 0;            // cross section [m^2]
    double edge = 0;                 // edge length of the cells in which they are placed [m]

    /// The attenuation coefficient of the particles [1/m]: they attenuate all light that meets
    /// their cross section.
    double attenuation() const { return number * mean_area; }
};

/// The indices of a cell of a class: positions of its particles at time 0 are from index * edge to
/// (index + 1) * edge along each axis.
using SnowCell = std::array<std::int64_t, 3>;

/// The snow of an unbounded ocean. No particles are stored: those of a cell, their number (a
/// Poisson distribution), positions (uniform) and diameters (JungeSizes), follow from the seed and
/// the cell alone, and all drift together, so that they are the same for every camera and frame.
class SnowField {
  public:
    explicit SnowField(const SnowDesc& desc);

    const std::vector<SnowClass>& classes() const { return classes_; }
    /// The displacement of all particles since time 0 [m].
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

/// The phase function of a large white sphere with a diffuse surface: p = 2/(3 pi^2) (sin psi - psi
/// cos psi) (Lambert 1760; Schönberg 1929).
class LambertSphere final : public PhaseFunction {
  public:
    using PhaseFunction::eval;
    void eval(std::span<const double> psi, std::span<double> p) const override {
        for (std::size_t i = 0; i < psi.size(); ++i) p[i] = at(psi[i]);
    }
    std::string description() const override { return "diffuse spheres"; }

    static double at(double psi) {
        return 2 / (3 * std::numbers::pi * std::numbers::pi) *
               (std::sin(psi) - psi * std::cos(psi));
    }
};

/// The coefficients of snow, as means over many particles: `attenuation` is their cross section per
/// volume [1/m], and `scattering` that times their reflectance. Their phase function is that of
/// LambertSphere.
struct SnowCoefficients {
    double attenuation = 0;
    Spectrum scattering{};
};
SnowCoefficients snow_coefficients(const SnowDesc& snow);

/// Adds the coefficients of snow to the uniform water of `medium`.
void add_snow(const SnowDesc& snow, Medium& medium);

/// Returns `medium`, whose coefficients contain the snow, without scattering by the snow, but with
/// the same attenuation. Throws InputError if snow scatters more, in some direction and band, than
/// the uniform water.
Medium without_snow(const SnowDesc& snow, const Medium& medium);

/// Returns `medium`, whose coefficients contain the snow, with scattering by the snow alone, but
/// with the same attenuation.
Medium snow_alone(const SnowDesc& snow, const Medium& medium);

/// Adds the mean in-scattering by particles beyond the distance up to which they are drawn one by
/// one to that of the water without snow.
class BeyondSnow final : public Integrator {
  public:
    /// A class of particles: it is drawn up to the distance `range` [m], and scatters this fraction
    /// of the light that all snow scatters.
    struct Part {
        double range = 0, fraction = 0;
    };

    /// `water` integrates without_snow, and `snow` integrates snow_alone.
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

/// The snow of a scene for one of its cameras (docs/snow.md).
struct SnowModel {
    SnowField field;
    /// The distances along rays in water up to which particles of each class are drawn [m]; those
    /// beyond are represented by their mean.
    std::vector<double> ranges{};
    double expected_count = 0;  // of drawn particles in the view
    Medium water;               // without scattering by snow
    Medium alone;               // with scattering by snow alone
    std::optional<std::string> warning{};

    /// Returns the mean optical depth of the drawn particles up to a distance [m]. The water's
    /// coefficients include it, although the drawn particles attenuate light, too.
    double drawn_depth(double distance) const;
    /// The parts of BeyondSnow.
    std::vector<BeyondSnow::Part> parts() const;
};

/// Makes the snow of a scene for a camera. The coefficients of `medium` contain the snow's mean.
/// Throws as without_snow.
std::shared_ptr<const SnowModel> make_snow_model(const SnowDesc& desc, const Camera& camera,
                                                 const Medium& medium);

}  // namespace uw
