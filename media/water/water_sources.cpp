#include "media/water/water_sources.h"

#include <fmt/format.h>

#include "media/water/jerlov.h"

namespace uw {

namespace {

std::string absorption_source(const WaterDesc& water, double small_ppm, double large_ppm) {
    std::string text;
    const std::string state =
        fmt::format("{:g} deg C, {:g} PSU", water.temperature, water.salinity);
    if (water.absorption) {
        text = "absorption: as given per band";
    } else if (!water.preset.empty()) {
        const JerlovPreset& preset = jerlov_preset(water.preset);
        text = fmt::format(
            "absorption: {} as measured from {:g} to {:g} nm (Williamson and Hollins 2022); its "
            "excess over pure water's (WOPP v3, Roettgers et al. 2016; {}) is interpolated, and "
            "held beyond",
            preset.name, preset.measured.first_nm, preset.measured.last_nm, state);
    } else {
        text = fmt::format("absorption: pure water, WOPP v3 (Roettgers et al. 2016), {}", state);
    }
    if (!water.absorption && water.cdom > 0)
        text += fmt::format(
            "; dissolved matter {:g} 1/m at 440 nm, exp(-0.014 (nm - 440)) "
            "(Bricaud et al. 1981)",
            water.cdom);
    if (!water.absorption && water.chlorophyll > 0)
        text += fmt::format("; chlorophyll {:g} mg/m^3 (Bricaud et al. 1995)", water.chlorophyll);
    if (water.mineral_absorption && small_ppm + large_ppm > 0)
        text += water.absorption || water.preset.empty()
                    ? "; particles as mineral (Babin et al. 2003)"
                    : "; particles beyond the preset's own as mineral (Babin et al. 2003)";
    return text;
}

std::string scattering_source(const WaterDesc& water, double small_ppm, double large_ppm) {
    if (water.scattering) return "scattering: as given per band, with one phase function";
    std::string text =
        fmt::format("scattering: water's molecules, Einstein-Smoluchowski (Morel 1974), {:g} PSU",
                    water.salinity);
    if (small_ppm + large_ppm == 0) return text;
    text += fmt::format(
        "; Kopelevich's particles (1983; Mobley 1994), {:.4g} ppm small, "
        "{:.4g} ppm large",
        small_ppm, large_ppm);
    if (!water.preset.empty() && !(water.small_ppm && water.large_ppm))
        text += fmt::format(", to scatter as {} (Williamson and Hollins 2022)",
                            jerlov_preset(water.preset).name);
    return text;
}

std::string grid_source(const VolumeDesc& volume, const GridMappingDesc& grid) {
    const std::string place =
        fmt::format("grid '{}' of {}: 1 unit is ", grid.grid, volume.file.filename().string());
    if (!grid.optics)
        return place +
               fmt::format("{:g} ppm small, {:g} ppm large", grid.small_ppm, grid.large_ppm);
    return place + (grid.optics->phase ? "coefficients as given, with a phase function"
                                       : "coefficients as given, with the water's phase function");
}

}  // namespace

std::vector<std::string> water_sources(const WaterDesc& water,
                                       const std::vector<VolumeDesc>& volumes, double small_ppm,
                                       double large_ppm) {
    std::vector<std::string> lines{absorption_source(water, small_ppm, large_ppm),
                                   scattering_source(water, small_ppm, large_ppm)};
    for (const VolumeDesc& volume : volumes)
        for (const GridMappingDesc& grid : volume.grids) lines.push_back(grid_source(volume, grid));
    return lines;
}

}  // namespace uw
