#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"
#include "media/water/water_model.h"

/// Scene descriptions of water and grids for the tests of what is built from them.
namespace uw::test {

inline WaterDesc basic_water() {
    WaterDesc water;
    water.bands_nm = {620, 540, 450};
    water.where = "scene.yaml:3:1: water";
    return water;
}

inline GridMappingDesc particle_grid(const std::string& name, double small_ppm, double large_ppm) {
    GridMappingDesc grid;
    grid.grid = name;
    grid.small_ppm = small_ppm;
    grid.large_ppm = large_ppm;
    grid.where = "scene.yaml:9:5: volumes[0].grids." + name;
    return grid;
}

inline PhaseDesc hg(double g) {
    return {HenyeyGreensteinDesc{g}, "scene.yaml:5:9: water.scattering.phase"};
}

inline GridMappingDesc optics_grid(const std::string& name, const PerBand& absorption,
                                   const PerBand& scattering, std::optional<PhaseDesc> phase) {
    GridMappingDesc grid = particle_grid(name, 0, 0);
    grid.optics = GridMappingDesc::Optics{absorption, scattering, std::move(phase)};
    return grid;
}

inline VolumeDesc volume_of(std::vector<GridMappingDesc> grids) {
    VolumeDesc volume;
    volume.grids = std::move(grids);
    return volume;
}

inline double total_scattering(const OpticalCoefficients& x, std::size_t band) {
    double b = 0;
    for (const Spectrum& b_m : x.scattering) b += b_m[band];
    return b;
}

/// beta(psi) of some coefficients of the medium in one band.
inline double vsf(const Medium& medium, const OpticalCoefficients& x, std::size_t band,
                  double psi) {
    double beta = 0;
    for (std::size_t m = 0; m < medium.phase_functions.size(); ++m)
        beta += x.scattering[m][band] * medium.phase_functions[m]->eval(psi);
    return beta;
}

inline std::string refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing was refused";
}

inline void expect_consistent(const WaterModel& model) {
    const Medium& medium = model.medium;
    const auto phases = medium.phase_functions.size();
    EXPECT_EQ(medium.uniform.scattering.size(), phases);
    for (const Constituent& constituent : medium.constituents)
        EXPECT_EQ(constituent.per_unit.scattering.size(), phases);
    for (const auto& volume : model.loads)
        for (const auto& grid : volume)
            for (const GridLoad& load : grid) {
                EXPECT_GE(load.constituent, 0);
                EXPECT_LT(load.constituent, medium.constituent_count());
            }
}

}  // namespace uw::test
