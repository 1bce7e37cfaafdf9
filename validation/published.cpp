#include "validation/published.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/scene/scene_desc.h"
#include "media/water/phase_functions.h"
#include "media/water/species.h"
#include "media/water/water_types.h"
#include "render/measures/light_meter.h"
#include "render/renderer.h"
#include "validation/light_trial.h"
#include "validation/published_tables.h"

namespace uw {

bool PublishedFigure::passed() const {
    return is_bound ? difference() <= allowed() : std::abs(difference()) <= allowed();
}

bool PublishedComparison::passed() const {
    return std::ranges::all_of(figures, &PublishedFigure::passed);
}

namespace {

// Canonical problems (Mobley et al. 1993). Attenuation is 1/m, so that depths are optical depths.
// Water without end below, or a floor at 5 m.
constexpr const char* k_canonical_water = R"(
uwvdb: 1
camera:
  resolution: [8, 8]
  intrinsics: {{fov_x: 60}}
  pose: {{position: [0, -1, 0], look_at: [0, -1, -1], up: [0, 1, 0]}}
water:
  bands: [550]
  absorption: [{absorption}]
  scattering: {{b: [{scattering}], phase: {{type: hg, g: 0.9}}}}
  surface: {{height: 0, n: 1.34}}
{floor}
lamps: [{{name: sun, type: sun, direction: [{across}, {down}, 0], irradiance: [1]}}]
render: {{integrator: path}}
)";

std::shared_ptr<const PhaseFunction> canonical_phase(int problem) {
    if (problem != 1) {
        const CsvTable table = published_table("mobley1993_table2_phase.csv");
        return std::make_shared<TabulatedPhase>(table.curve("angle_deg", "phase"),
                                                "Mobley et al. 1993, table 2");
    }
    SampledCurve rayleigh;
    for (double angle = 0; angle <= 180; angle += 0.5) {
        const double cosine = std::cos(angle * k_degree);
        rayleigh.x.push_back(angle);
        rayleigh.y.push_back(1 + cosine * cosine);
    }
    return std::make_shared<TabulatedPhase>(rayleigh, "Rayleigh");
}

/// A problem's water, lit by its sun.
class CanonicalWater {
  public:
    /// `sun_angle`: of the sun in the air, from the zenith [degrees].
    CanonicalWater(int problem, double albedo, double sun_angle) {
        const std::string floor =
            problem == 6 ? "geometry: [{type: plane, point: [0, -5, 0], normal: [0, 1, 0], "
                           "reflectance: [0.5]}]"
                         : "";
        const std::string text = fmt::format(
            k_canonical_water, fmt::arg("absorption", 1 - albedo), fmt::arg("scattering", albedo),
            fmt::arg("floor", floor), fmt::arg("across", std::sin(sun_angle * k_degree)),
            fmt::arg("down", -std::cos(sun_angle * k_degree)));
        renderer_.set_scene(ImageScene(read_scene_text(text, "canonical.yaml")));
        renderer_.edit([&](AssembledScene& scene) {
            scene.water.medium.phase_functions.front() = canonical_phase(problem);
        });
        meter_.emplace(renderer_.assemble());
    }

    /// A little above a floor that is there.
    MeterReading read(double depth, int rays) const {
        return meter_->read({0, -depth + (depth == 5 ? 1e-4 : 0), 0}, {0, 1, 0}, rays);
    }

  private:
    Renderer renderer_;
    std::optional<LightMeter> meter_;
};

/// One quantity of a reading, by its name in the table.
MeteredSpectrum quantity_of(const MeterReading& reading, const std::string& name) {
    if (name == "Ed") return reading.down;
    if (name == "Eou") return reading.scalar_up;
    return reading.radiance_up;
}

void append_canonical(const PublishedOptions& options, std::vector<PublishedFigure>& figures) {
    const CsvTable table = published_table("mobley1993_means.csv");
    constexpr double k_of_irradiance = 0.015, k_rounding = 0.005;  // three digits are printed
    constexpr double k_sun_angle = 60;
    const std::vector<double> problems = table.numbers("problem"),
                              albedos = table.numbers("omega0"), depths = table.numbers("tau"),
                              means = table.numbers("mean"), spreads = table.numbers("cv");
    const std::vector<std::string> quantities = table.text("quantity");
    std::optional<CanonicalWater> water;
    std::map<double, MeterReading> readings;  // by depth
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const std::string name = fmt::format("problem {:g}", problems[row]);
        if (!options.only.empty() && options.only != name) continue;
        if (!water || problems[row] != problems[row - 1] || albedos[row] != albedos[row - 1]) {
            options.say(fmt::format("{}, albedo {:g}", name, albedos[row]));
            water.emplace(static_cast<int>(problems[row]), albedos[row], k_sun_angle);
            readings.clear();
        }
        const double depth = depths[row];
        if (!readings.contains(depth)) readings[depth] = water->read(depth, options.rays);
        const MeteredSpectrum value = quantity_of(readings[depth], quantities[row]);
        PublishedFigure figure;
        figure.source = "Mobley et al. 1993, " + name;
        figure.quantity =
            fmt::format("{} at depth {:g}, albedo {:g}", quantities[row], depth, albedos[row]);
        figure.published = means[row];
        figure.spread = spreads[row];
        figure.ours = value.mean[0];
        figure.error = value.mean[0] > 0 ? value.error[0] / value.mean[0] : 0;
        figure.tolerance = std::max(k_of_irradiance, 2 * figure.spread);
        if (quantities[row] != "Ed") figure.tolerance += k_rounding;
        figure.place = {fmt::format("{}, albedo {:g}", name, albedos[row]), quantities[row],
                        "optical depth", depth};
        figures.push_back(std::move(figure));
    }
}

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

// K of the irradiance between two depths so great that only the slowest part of the light is left,
// below a sun at the zenith.
void append_asymptotic(const PublishedOptions& options, std::vector<PublishedFigure>& figures) {
    constexpr double k_depths[] = {15, 27};  // optical
    const CsvTable table = published_table("mobley1993_asymptotic.csv");
    const std::vector<double> albedos = table.numbers("omega0"), least = table.numbers("least"),
                              greatest = table.numbers("greatest");
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        options.say(fmt::format("asymptotic K, albedo {:g}", albedos[row]));
        const CanonicalWater water(2, albedos[row], 0);
        double logarithm = 0, variance = 0;
        for (const double depth : k_depths) {
            const MeteredSpectrum down = water.read(depth, options.rays).down;
            logarithm += (depth == k_depths[0] ? 1 : -1) * std::log(down.mean[0]);
            variance += std::pow(down.error[0] / down.mean[0], 2);
        }
        PublishedFigure figure;
        figure.source = "Mobley et al. 1993, problem 2";
        figure.quantity = fmt::format("asymptotic K, albedo {:g} [c]", albedos[row]);
        figure.published = (least[row] + greatest[row]) / 2;
        figure.spread = greatest[row] / figure.published - 1;
        figure.ours = logarithm / (k_depths[1] - k_depths[0]);
        figure.error = std::sqrt(variance) / logarithm;
        figure.tolerance = figure.spread;
        figures.push_back(std::move(figure));
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
    append_canonical(options, comparison.figures);
    if (wants("asymptotic K")) append_asymptotic(options, comparison.figures);
    if (wants("Petzold")) append_petzold(comparison.figures);
    if (wants("Cycles")) append_cycles(options, comparison.figures);
    return comparison;
}

}  // namespace uw
