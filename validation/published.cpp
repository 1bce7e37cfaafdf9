#include "validation/published.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "camera/camera.h"
#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/scene/scene_desc.h"
#include "media/water/phase_functions.h"
#include "render/measures/light_meter.h"
#include "render/renderer.h"

namespace uw {

bool PublishedFigure::passed() const {
    const double allowed = tolerance + 2 * error;
    return is_bound ? difference() <= allowed : std::abs(difference()) <= allowed;
}

namespace {

CsvTable table_called(std::string_view name) {
    for (const PublishedTable& table : published_tables())
        if (table.name == name) return CsvTable(table.text, std::string(name));
    throw std::logic_error("no such table of published figures: " + std::string(name));
}

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
lamps: [{{name: sun, type: sun, direction: [{across}, -0.5, 0], irradiance: [1]}}]
render: {{integrator: path}}
)";

std::shared_ptr<const PhaseFunction> canonical_phase(int problem) {
    if (problem != 1) {
        const CsvTable table = table_called("mobley1993_table2_phase.csv");
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
    CanonicalWater(int problem, double albedo) {
        const std::string floor =
            problem == 6 ? "geometry: [{type: plane, point: [0, -5, 0], normal: [0, 1, 0], "
                           "reflectance: [0.5]}]"
                         : "";
        const std::string text = fmt::format(
            k_canonical_water, fmt::arg("absorption", 1 - albedo), fmt::arg("scattering", albedo),
            fmt::arg("floor", floor), fmt::arg("across", std::numbers::sqrt3 / 2));
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
    const CsvTable table = table_called("mobley1993_means.csv");
    constexpr double k_of_irradiance = 0.015, k_rounding = 0.005;  // three digits are printed
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
            water.emplace(static_cast<int>(problems[row]), albedos[row]);
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
        figures.push_back(std::move(figure));
    }
}

/// Photographs through a port, and the camera that took them.
struct Photographs {
    const char* table;
    const char* source;
    const char* camera;
    double published;  // RMS of an independent model of the port [px]
};

constexpr Photographs k_photographs[] = {
    {"flat_port.csv", "14 photographs through a flat port",
     "{resolution: [648, 486], intrinsics: {fx: 704.2503362080547, fy: 704.5253520972772, cx: "
     "311.07539864073345, cy: 231.63444961832204}, distortion: {model: brown-conrady, k: "
     "[-0.16466655995965362, 0.3639292712426501, 0], p: [-0.0035347701314374052, "
     "0.0017529132113182353]}, port: {type: flat, normal: [0.03187842988317765, "
     "0.007419777520423672, 0.999464212770888], distance: 0.0014159163813140608, thickness: 0.01, "
     "n_air: 1.0, n_glass: 1.49, n_water: 1.333}}",
     0.357},
    {"dome_port.csv", "74 photographs through a dome",
     "{resolution: [1440, 1080], intrinsics: {fx: 2415.732657933524, fy: 2420.953074246, cx: "
     "752.7733815206981, cy: 571.8066981186872}, distortion: {model: brown-conrady, k: "
     "[-0.36315848398496675, 0.06811987606712908, 1.1730456449148083], p: "
     "[0.0009552456724762491, 0.0006011333369216497]}, port: {type: dome, center: "
     "[0.0010739276438524533, -0.0014321366132178607, -0.005296524028375461], radius: 0.043552, "
     "thickness: 0.0037499999999999964, n_air: 1.0, n_glass: 1.495, n_water: 1.333}}",
     0.228},
    {"tank.csv", "a photograph through a tank of 256 mm",
     "{resolution: [3456, 2304], intrinsics: {fx: 2855.7123372189926, fy: 2856.713502076052, cx: "
     "1783.0502357964347, cy: 1171.8751102388067}, port: {type: flat, normal: "
     "[-0.19836545283469129, -0.08802350151204377, 1], distance: 0.02, thickness: "
     "0.2556931817358324, n_air: 1.0, n_glass: 1.33, n_water: 1.0}}",
     0.465},
};

void append_photographs(std::vector<PublishedFigure>& figures) {
    for (const Photographs& photographs : k_photographs) {
        const SceneDesc scene = read_scene_text(
            fmt::format("uwvdb: 1\ncamera: {}\n", photographs.camera), "photographs.yaml");
        const Camera camera(scene.camera);
        const CsvTable table = table_called(photographs.table);
        const std::vector<double> x = table.numbers("x"), y = table.numbers("y"),
                                  z = table.numbers("z"), u = table.numbers("u"),
                                  v = table.numbers("v");
        double squares = 0;
        for (std::size_t row = 0; row < table.row_count(); ++row) {
            const auto seen = camera.project({x[row], y[row], z[row]});
            if (!seen) throw std::logic_error("a corner that was photographed cannot be seen");
            squares += std::pow(seen->x - u[row], 2) + std::pow(seen->y - v[row], 2);
        }
        PublishedFigure figure;
        figure.source = photographs.source;
        figure.quantity = fmt::format("RMS of {} corners [px]", table.row_count());
        figure.published = photographs.published;
        figure.ours = std::sqrt(squares / static_cast<double>(table.row_count()));
        figure.tolerance = 0.002;  // the published are rounded to their third digit
        figure.is_bound = true;
        figures.push_back(std::move(figure));
    }
}

}  // namespace

std::vector<PublishedFigure> compare_with_published(const PublishedOptions& options) {
    std::vector<PublishedFigure> figures;
    append_photographs(figures);
    append_canonical(options, figures);
    return figures;
}

}  // namespace uw
