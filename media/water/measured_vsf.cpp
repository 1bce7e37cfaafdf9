#include "media/water/measured_vsf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "media/water/molecular_phase.h"
#include "media/water/water_types.h"

namespace uw {

namespace {

constexpr double k_petzold_nm = 514;
constexpr std::string_view k_prefix = "beta_";

MeasuredVsf read_vsf_table(const CsvTable& table, const SourceLocation& where) {
    std::vector<std::pair<double, std::string>> columns;
    for (const std::string& column : table.columns()) {
        if (column == "angle_deg") continue;
        double nm = 0;
        const bool is_beta = column.starts_with(k_prefix) &&
                             parse_number(std::string_view(column).substr(k_prefix.size()), nm) ==
                                 NumberText::number;
        if (!is_beta || !(nm >= 200 && nm <= 1100))
            throw InputError(
                fmt::format("{}: {} has a column {}; name columns angle_deg and, of volume "
                            "scattering functions in 1/(m sr), beta_514 by their wavelength in nm "
                            "from 200 to 1100",
                            where, table.name(), quoted_cell(column)));
        columns.emplace_back(nm, column);
    }
    if (columns.empty())
        throw InputError(fmt::format(
            "{}: {} has no volume scattering function; give it a column such as beta_514, in "
            "1/(m sr)",
            where, table.name()));
    std::ranges::sort(columns);
    MeasuredVsf vsf;
    for (const auto& [nm, column] : columns) {
        if (!vsf.wavelengths_nm.empty() && nm == vsf.wavelengths_nm.back())
            throw InputError(fmt::format("{}: {} has two columns for {:g} nm; remove one", where,
                                         table.name(), nm));
        vsf.wavelengths_nm.push_back(nm);
        vsf.beta.push_back(table.curve("angle_deg", column));
        if (vsf.beta.back().x != vsf.beta.front().x)
            throw InputError(fmt::format(
                "{}: {} has other angles at {:g} than at {:g} nm; give every wavelength a value at "
                "each angle",
                where, table.name(), nm, vsf.wavelengths_nm.front()));
    }
    return vsf;
}

double molecular_vsf(double wavelength_nm, double salinity, double angle_deg) {
    const double cosine = std::cos(angle_deg * std::numbers::pi / 180);
    return water_vsf_90(wavelength_nm, salinity) *
           (1 + MolecularPhase::k_anisotropy * cosine * cosine);
}

}  // namespace

MeasuredVsf read_measured_vsf(const SpeciesDesc& species) {
    const MeasuredVsfDesc& desc = *species.vsf;
    if (!desc.library.empty())
        return {{k_petzold_nm},
                {read_embedded_table("petzold_vsf.csv").curve("angle_deg", desc.library)}};
    return read_vsf_table(read_csv_file(desc.file, species.where), species.where);
}

SampledCurve particle_vsf(const MeasuredVsf& measured, const SpeciesDesc& species,
                          double wavelength_nm, double salinity) {
    const auto of_particles = [&](std::size_t at) {
        SampledCurve beta = measured.beta[at];
        if (!species.vsf->has_water) return beta;
        for (std::size_t i = 0; i < beta.x.size(); ++i) {
            beta.y[i] -= molecular_vsf(measured.wavelengths_nm[at], salinity, beta.x[i]);
            if (!(beta.y[i] >= 0))
                throw InputError(fmt::format(
                    "{}: at {:g} degrees and {:g} nm the sample scatters less than water's "
                    "molecules alone; write water: removed, if they are not part of it",
                    species.where, beta.x[i], measured.wavelengths_nm[at]));
        }
        return beta;
    };
    const std::vector<double>& known = measured.wavelengths_nm;
    const auto above =
        static_cast<std::size_t>(std::ranges::lower_bound(known, wavelength_nm) - known.begin());
    if (above == 0) return of_particles(0);
    if (above == known.size()) return of_particles(above - 1);
    SampledCurve beta = of_particles(above - 1);
    const SampledCurve next = of_particles(above);
    const double t = (wavelength_nm - known[above - 1]) / (known[above] - known[above - 1]);
    for (std::size_t i = 0; i < beta.y.size(); ++i) beta.y[i] = std::lerp(beta.y[i], next.y[i], t);
    return beta;
}

}  // namespace uw
