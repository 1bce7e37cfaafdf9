#include "render/validation/canonical_problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "core/geometry/waves.h"
#include "core/light/strata.h"
#include "core/light/submerged.h"
#include "core/scene/scene_desc.h"
#include "media/volumes/stratified_field.h"
#include "media/water/tabulated_phase.h"
#include "render/meters/light_meter.h"
#include "render/scene_assembly.h"
#include "render/scene_cache.h"
#include "render/validation/published_tables.h"

namespace uw {

namespace {

// Attenuation is 1/m but in problem 3, so that depths are optical depths. Water without end below,
// or a floor at 5 m.
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
  surface: {{height: 0, n: 1.34{waves}}}
{floor}
lamps: [{{name: sun, type: sun, direction: [{across}, {down}, 0], irradiance: [1]}}]
render: {{integrator: path}}
)";

constexpr const char* k_floor =
    "geometry: [{type: plane, point: [0, -5, 0], normal: [0, 1, 0], reflectance: [0.5]}]";

// Problem 5: slopes of a variance of 0.04, alike in all directions and nearly Gaussian, which is
// all of the waves that it names. Their size does not matter.
constexpr double k_tile = 4, k_slope_variance = 0.04;  // [m], 1
constexpr const char* k_waves =
    ", waves: {type: jonswap, wind: 7.23, fetch: 11, spreading: 1, tile: 4, resolution: 256}";

/// A Gaussian on a constant background [mg/m^3], by depth [m] (equation 7).
double chlorophyll(double depth) {
    constexpr double k_constant = 0.2, k_deviation = 9, k_peak = 17, k_column = 144;
    const double x = (depth - k_peak) / k_deviation;
    return k_constant +
           k_column / (k_deviation * std::sqrt(2 * std::numbers::pi)) * std::exp(-0.5 * x * x);
}

std::shared_ptr<const PhaseFunction> particles_phase() {
    const CsvTable table = published_table("mobley1993_table2_phase.csv");
    return std::make_shared<TabulatedPhase>(table.curve("angle_deg", "phase"),
                                            "Mobley et al. 1993, table 2");
}

std::shared_ptr<const PhaseFunction> molecules_phase() {
    SampledCurve rayleigh;
    for (double angle = 0; angle <= 180; angle += 0.5) {
        const double cosine = std::cos(angle * k_degree);
        rayleigh.x.push_back(angle);
        rayleigh.y.push_back(1 + cosine * cosine);
    }
    return std::make_shared<TabulatedPhase>(rayleigh, "Rayleigh");
}

/// Problem 3: sea water at 500 nm (equation 8), and the absorption and scattering of particles by
/// the chlorophyll (equation 6).
void stratify(AssembledScene& scene) {
    constexpr double k_step = 0.5, k_bottom = 80;  // [m]; 0.04 % of chlorophyll between depths
    Spectrum water_absorption{}, water_scattering{}, absorbed{}, scattered{};
    water_absorption[0] = 0.0257;
    water_scattering[0] = 0.0029;
    absorbed[0] = 0.04;
    scattered[0] = 0.33;
    Medium& medium = scene.water.medium;
    medium.phase_functions = {molecules_phase(), particles_phase()};
    medium.uniform = {water_absorption, {water_scattering, {}}};
    medium.constituents = {{"absorbing", "1", {absorbed, {{}, {}}}},
                           {"scattering", "1", {{}, {{}, scattered}}}};
    std::vector<double> depths;
    Strata::Curve absorbing{0, {}}, scattering{1, {}};
    for (double depth = 0; depth <= k_bottom; depth += k_step) {
        depths.push_back(depth);
        absorbing.values.push_back(std::pow(chlorophyll(depth), 0.602));
        scattering.values.push_back(std::pow(chlorophyll(depth), 0.620));
    }
    const WaterSurfaceDesc& surface = *scene.desc().water.surface;
    scene.water.strata = std::make_shared<Strata>(surface.point, surface.normal, std::move(depths),
                                                  std::vector{absorbing, scattering});
    scene.field = std::make_shared<SubmergedField>(make_field({}, 2, scene.water.strata),
                                                   *scene.water_surface, false);
}

/// A row of the published tables.
struct PublishedMean {
    int problem = 0;
    double albedo = 0;  // of problem 3 none: it changes with depth
    double depth = 0;   // optical; of problem 3 [m]
    std::string quantity;
    double mean = 0, spread = 0;

    std::string name() const { return fmt::format("problem {}", problem); }
    std::string water() const {
        return problem == 3 ? name() : fmt::format("{}, albedo {:g}", name(), albedo);
    }
};

std::vector<PublishedMean> published_means() {
    std::vector<PublishedMean> means;
    for (const bool is_stratified : {false, true}) {
        const CsvTable table =
            published_table(is_stratified ? "mobley1993_stratified.csv" : "mobley1993_means.csv");
        const std::size_t count = table.row_count();
        const std::vector<double> problems = is_stratified ? std::vector<double>(count, 3)
                                                           : table.numbers("problem"),
                                  albedos = is_stratified ? std::vector<double>(count, 0)
                                                          : table.numbers("omega0"),
                                  depths = table.numbers(is_stratified ? "depth_m" : "tau"),
                                  values = table.numbers("mean"), spreads = table.numbers("cv");
        const std::vector<std::string> quantities = table.text("quantity");
        for (std::size_t row = 0; row < count; ++row)
            means.push_back({static_cast<int>(problems[row]), albedos[row], depths[row],
                             quantities[row], values[row], spreads[row]});
    }
    return means;
}

/// A problem's water, lit by its sun.
class CanonicalWater {
  public:
    /// `sun_angle`: of the sun in the air, from the zenith [degrees].
    CanonicalWater(int problem, double albedo, double sun_angle) : has_waves_(problem == 5) {
        const std::string text = fmt::format(k_canonical_water, fmt::arg("absorption", 1 - albedo),
                                             fmt::arg("scattering", albedo),
                                             fmt::arg("waves", has_waves_ ? k_waves : ""),
                                             fmt::arg("floor", problem == 6 ? k_floor : ""),
                                             fmt::arg("across", std::sin(sun_angle * k_degree)),
                                             fmt::arg("down", -std::cos(sun_angle * k_degree)));
        SceneCache cache;
        scene_ = assemble_scene(read_scene_text(text, "canonical.yaml"), cache, [](Stage) {});
        scene_->scattering = nullptr;  // another water
        if (problem == 3)
            stratify(*scene_);
        else
            scene_->water.medium.phase_functions.front() =
                problem == 1 ? molecules_phase() : particles_phase();
        meter_.emplace(*scene_);
    }

    /// A little above a floor that is there; at several places where waves focus the light.
    std::vector<MeterReading> read(double depth, int rays) const {
        constexpr int k_places = 32;
        const double y = -depth + (depth == 5 ? 1e-4 : 0);
        if (!has_waves_) return {meter_->read({0, y, 0}, {0, 1, 0}, rays)};
        std::vector<MeterReading> readings;
        for (int i = 0; i < k_places; ++i) {
            const double along = (i + 0.5) / k_places, across = std::fmod(i * std::numbers::phi, 1);
            readings.push_back(meter_->read({k_tile * along, y, k_tile * across}, {0, 1, 0},
                                            std::max(16, rays / k_places)));
        }
        return readings;
    }

    const AssembledScene& scene() const { return *scene_; }

  private:
    bool has_waves_;
    std::optional<AssembledScene> scene_;
    std::optional<LightMeter> meter_;
};

/// One quantity by its name in the tables.
const MeteredSpectrum& quantity_of(const MeterReading& reading, const std::string& name) {
    if (name == "Ed") return reading.down;
    if (name == "Eou") return reading.scalar_up;
    return reading.radiance_up;
}

/// Sets the figure to the mean over places, with the error that their spread shows.
void set_mean(const std::vector<MeterReading>& readings, const std::string& quantity,
              PublishedFigure& figure) {
    const auto count = static_cast<double>(readings.size());
    double sum = 0, squares = 0;
    for (const MeterReading& reading : readings) {
        const double value = quantity_of(reading, quantity).mean[0];
        sum += value;
        squares += value * value;
    }
    const double error = readings.size() == 1
                             ? quantity_of(readings[0], quantity).error[0]
                             : std::sqrt((squares - sum * sum / count) / (count * (count - 1)));
    figure.ours = sum / count;
    figure.error = figure.ours > 0 ? error / figure.ours : 0;
}

PublishedFigure slopes_of(const AssembledScene& scene) {
    PublishedFigure figure;
    figure.source = "Mobley et al. 1993, problem 5";
    figure.quantity = "variance of the waves' slopes";
    figure.published = k_slope_variance;
    figure.ours = scene.water_surface->waves()->statistics().slopes.total();
    figure.tolerance = 0.01;  // makes less than 0.1 % of a difference to the light
    return figure;
}

}  // namespace

void append_canonical_problems(const PublishedOptions& options,
                               std::vector<PublishedFigure>& figures) {
    constexpr double k_of_irradiance = 0.015, k_rounding = 0.005;  // three digits are printed
    std::optional<CanonicalWater> water;
    std::string water_name;
    std::map<double, std::vector<MeterReading>> readings;  // by depth
    for (const PublishedMean& row : published_means()) {
        if (!options.only.empty() && options.only != row.name()) continue;
        if (water_name != row.water()) {
            water_name = row.water();
            options.say(water_name);
            water.emplace(row.problem, row.albedo, row.problem == 5 ? 80 : 60);
            readings.clear();
            if (row.problem == 5) figures.push_back(slopes_of(water->scene()));
        }
        if (!readings.contains(row.depth))
            readings[row.depth] = water->read(row.depth, options.rays);
        PublishedFigure figure;
        figure.source = "Mobley et al. 1993, " + row.name();
        figure.quantity = row.problem == 3 ? fmt::format("{} at {:g} m", row.quantity, row.depth)
                                           : fmt::format("{} at depth {:g}, albedo {:g}",
                                                         row.quantity, row.depth, row.albedo);
        figure.published = row.mean;
        figure.spread = row.spread;
        set_mean(readings[row.depth], row.quantity, figure);
        figure.tolerance = std::max(k_of_irradiance, 2 * figure.spread);
        if (row.quantity != "Ed") figure.tolerance += k_rounding;
        figure.place = {water_name, row.quantity, row.problem == 3 ? "depth [m]" : "optical depth",
                        row.depth};
        figures.push_back(std::move(figure));
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
            const MeteredSpectrum down = water.read(depth, options.rays).front().down;
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

}  // namespace uw
