#include "render/validation/published.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/scene/scene_desc.h"
#include "media/water/species.h"
#include "media/water/water_types.h"
#include "render/validation/canonical_problems.h"
#include "render/validation/light_trial.h"
#include "render/validation/published_tables.h"

namespace uw {

bool PublishedComparison::passed() const {
    return std::ranges::all_of(figures, &PublishedFigure::passed);
}

namespace {

void append_photographs(PublishedComparison& comparison) {
    constexpr double k_rounding = 0.002;  // the published are rounded to their third digit
    comparison.photographs = photographs_through_ports();
    for (const PortPhotographs& photographs : comparison.photographs) {
        const std::size_t corners = photographs.port.size();
        PublishedFigure port;
        port.source = photographs.source;
        port.quantity = fmt::format("RMS of {} corners [px]", corners);
        port.published = photographs.published_port;
        port.ours = rms_of(photographs.port);
        port.tolerance = k_rounding;
        port.is_bound = true;
        PublishedFigure plain;
        plain.source = photographs.source;
        plain.quantity = "the same without the port [px]";
        plain.published = photographs.published_plain;
        plain.ours = rms_of(photographs.plain);
        plain.tolerance = photographs.plain_rounding / photographs.published_plain;
        comparison.figures.push_back(std::move(port));
        comparison.figures.push_back(std::move(plain));
    }
}

void append_petzold(std::vector<PublishedFigure>& figures) {
    constexpr double k_wavelength = 514, k_salinity = 35;
    const CsvTable table = published_table("petzold1972_scattering.csv");
    const std::vector<std::string> species = table.text("species");
    const std::vector<double> scattering = table.numbers("b");
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const WaterDesc desc = read_water_overrides(
            {fmt::format("water={{species: {{x: {{library: {}}}}}}}", species[row])});
        PublishedFigure figure;
        figure.source = "Petzold 1972";
        figure.quantity = fmt::format("b of {} [1/m]", species[row]);
        figure.published = scattering[row];
        figure.ours = species_optics(desc.species[0], k_wavelength, desc).scattering +
                      water_scattering(k_wavelength, k_salinity);
        // Below 0.1 degrees nothing was measured, and how one extrapolates changes b.
        figure.tolerance = 0.01;
        figures.push_back(std::move(figure));
    }
}

void append_cycles(const PublishedOptions& options, std::vector<PublishedFigure>& figures) {
    const CsvTable table = published_table("cycles_point_lamp.csv");
    const std::vector<double> distances = table.numbers("distance"),
                              angles = table.numbers("angle"),
                              radiances = table.numbers("radiance"),
                              errors = table.numbers("error");
    options.say("Cycles");
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const LightMean ours = scattered_around_lamp(distances[row], angles[row]);
        PublishedFigure figure;
        figure.source = "Blender 3.4.1, Cycles";
        figure.quantity = fmt::format("radiance {:g} m from a lamp, {:g} degrees aside",
                                      distances[row], angles[row]);
        figure.published = radiances[row];
        figure.spread = errors[row];
        figure.ours = ours.mean();
        figure.error = ours.error() / ours.mean();
        // Light leaves our point lamp, but for 0.08 %, from a sphere of 1 mm without scattering.
        figure.tolerance = 2 * figure.spread + 0.001;
        figure.place = {"Blender's Cycles: radiance around a lamp",
                        fmt::format("{:g} m", distances[row]), "degrees aside", angles[row]};
        figures.push_back(std::move(figure));
    }
}

}  // namespace

PublishedComparison compare_with_published(const PublishedOptions& options) {
    PublishedComparison comparison;
    const auto wants = [&](const char* part) {
        return options.only.empty() || options.only == part;
    };
    if (wants("photographs")) append_photographs(comparison);
    append_canonical_problems(options, comparison.figures);
    if (wants("asymptotic K")) append_asymptotic(options, comparison.figures);
    if (wants("Petzold")) append_petzold(comparison.figures);
    if (wants("Cycles")) append_cycles(options, comparison.figures);
    return comparison;
}

}  // namespace uw
