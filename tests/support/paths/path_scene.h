#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/geometry_scene.h"
#include "core/geometry/glass.h"
#include "core/light/integrator.h"
#include "media/volumes/grid_field.h"
#include "tests/support/described_phase.h"

/// Scenes for light paths, made by hand: no file, no camera, any number of bands.
namespace uw::test {

/// Coefficients of water or particles in one band [1/m].
struct BandOptics {
    double absorption = 0, scattering = 0;
};

/// Owns what a LitScene refers to. Starts as uniform water in endless space.
struct PathScene {
    Medium medium;
    std::unique_ptr<const ConcentrationField> field;
    std::unique_ptr<const Surfaces> surfaces;
    std::vector<Lamp> lamps;
    std::shared_ptr<const GlassOptics> glass;  // null: no surface is of glass

    /// Uniform water with a Henyey-Greenstein phase function, one entry of `bands` per band.
    PathScene(const std::vector<BandOptics>& bands, double g)
        : field(std::make_unique<GridField>(std::vector<GridVolume>(), 0)) {
        medium.phase_functions = {henyey_greenstein(g)};
        medium.uniform.scattering.resize(1);
        for (std::size_t b = 0; b < bands.size(); ++b) {
            medium.wavelengths_nm.push_back(450 + 10 * static_cast<double>(b));
            medium.uniform.absorption[b] = bands[b].absorption;
            medium.uniform.scattering[0][b] = bands[b].scattering;
        }
        set_surfaces({});
    }

    /// Fills `new_field`'s first constituent with particles: `bands` at a concentration of 1.
    void set_field(std::unique_ptr<const ConcentrationField> new_field,
                   const std::vector<BandOptics>& bands, double g) {
        field = std::move(new_field);
        medium.phase_functions.push_back(henyey_greenstein(g));
        medium.uniform.scattering.emplace_back();
        Constituent particles{"particles", "1", {}};
        particles.per_unit.scattering.resize(2);
        for (std::size_t b = 0; b < bands.size(); ++b) {
            particles.per_unit.absorption[b] = bands[b].absorption;
            particles.per_unit.scattering[1][b] = bands[b].scattering;
        }
        medium.constituents = {particles};
    }

    void set_surfaces(std::vector<GeometryDesc> geometry) {
        std::vector<std::string> warnings;
        surfaces = build_surfaces(geometry, medium.wavelengths_nm, warnings);
    }

    /// Adds a lamp of `intensity` W/sr in every band.
    void add_lamp(const Point3& position, double intensity,
                  const LampProfile& profile = IsotropicProfile()) {
        const Spectrum bands = per_band(band_count(), [&](std::size_t) { return intensity; });
        const Lamp lamp("lamp" + std::to_string(lamps.size()), position, profile, bands);
        lamps.push_back(lamp.with_index(lamps.size()));
    }

    std::size_t band_count() const { return medium.wavelengths_nm.size(); }
    LitScene lit() const {
        LitScene scene{&medium, field.get(), surfaces.get(), &lamps};
        scene.glass = glass.get();
        return scene;
    }
};

/// A description with the same reflectance in all of `bands` bands.
inline GeometryDesc with_reflectance(GeometryDesc desc, double reflectance, std::size_t bands) {
    desc.reflectance = PerBand(bands, reflectance);
    return desc;
}

}  // namespace uw::test
