#pragma once

#include <string>

#include "cli/tools/water_report.h"

/// Small reports on water for the tests of what is made of them.
namespace uw::test {

/// Pure sea water at two wavelengths that tables of 2 nm have.
inline WaterSurvey report_on_water() {
    WaterSurvey report;
    report.title = "clear";
    report.sources = {"a source"};
    report.water.bands_nm = {540, 450};
    report.table = tabulate_water(report.water, {});
    report.vsf_bands = {0};
    return report;
}

/// The same with a grid that absorbs and does not scatter.
inline WaterSurvey report_with_dye(const std::string& name) {
    WaterSurvey report = report_on_water();
    VolumeDesc volume;
    volume.file = "plume.vdb";
    volume.grids.resize(1);
    volume.grids[0].grid = name;
    volume.grids[0].optics = GridMappingDesc::Optics{{0.5, 0.25}, {0, 0}, std::nullopt};
    report.volumes = {volume};
    report.table = tabulate_water(report.water, report.volumes);
    return report;
}

}  // namespace uw::test
