#include "cli/tools/measure_command.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/pages/svg_plot.h"
#include "cli/report.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "render/meters/light_meter.h"
#include "render/renderer.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

const char* const k_measure_examples = R"(Examples:
  uwvdb measure pool.yaml                        every sensor of the scene, band by band
  uwvdb measure pool.yaml --csv pool.csv --svg pool.svg
  uwvdb measure pool.yaml --rays 65536 --json

Reads the scene's `sensors` in all light, scattered and reflected any number of times: plane
irradiance that travels down and up (Ed, Eu), scalar irradiance from above and below (Eod, Eou),
in W/m2, radiance that travels straight up (Lu), in W/(m2 sr), each with its standard error; the
irradiance reflectance R = Eu/Ed, and between points of a line Kd = -d ln Ed / d depth [1/m]. At
the water's surface where a sensor begins, if it has an index n, is calm and is lit from the air:
the water-leaving radiance Lw and the remote-sensing reflectance Rrs = Lw/Ed, both in the air.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

struct MeasureArguments {
    std::filesystem::path scene, csv, svg;
    std::vector<std::string> overrides;
    int rays = 4096;
    int threads = 0;
    bool json = false, quiet = false;
    ProgressForm progress = ProgressForm::text;
};

Options measure_options(MeasureArguments& a) {
    Options options;
    options.input("SCENE", "", a.scene, "scene file with sensors").required = true;
    options.set(a.overrides);
    options.integer("--rays", "N", a.rays, 16, 1 << 24,
                    "rays from each point; the standard error falls with their square root");
    options.output("--csv", "FILE", a.csv, "write all readings as a table");
    options.output("--svg", "FILE", a.svg, "plot the irradiance along lines of sensors");
    options.flag("--json", a.json, "print everything as JSON instead of tables");
    options.threads(a.threads);
    options.messages(a.quiet, a.progress);
    return options;
}

/// A quantity of a reading, as tables name it.
struct Quantity {
    const char* name;
    MeteredSpectrum MeterReading::*value;
};

constexpr std::array<Quantity, 6> k_quantities{{{"Ed", &MeterReading::down},
                                                {"Eu", &MeterReading::up},
                                                {"Eod", &MeterReading::scalar_down},
                                                {"Eou", &MeterReading::scalar_up},
                                                {"Lu", &MeterReading::radiance_up},
                                                {"Ld", &MeterReading::radiance_down}}};

struct Reading {
    Point3 point;
    std::optional<double> depth;  // below the water's surface [m]
    MeterReading value;
};

struct SensorReadings {
    const MeterDesc* sensor;
    std::vector<Reading> readings;
    std::optional<WaterLeaving> leaving;  // at the surface above the first

    /// -d ln Ed / ds along the line before point `i` [1/m]; none at the first.
    std::optional<double> attenuation(std::size_t i, std::size_t band) const {
        if (i == 0) return std::nullopt;
        const double way = glm::dot(readings[i - 1].point - readings[i].point, sensor->up);
        const double before = readings[i - 1].value.down.mean[band];
        const double here = readings[i].value.down.mean[band];
        if (way == 0 || !(before > 0) || !(here > 0)) return std::nullopt;
        return std::log(before / here) / way;
    }
};

std::vector<SensorReadings> read_all(const MeasureArguments& a, const AssembledScene& scene) {
    const SceneDesc& desc = scene.desc();
    std::size_t count = 0;
    for (const MeterDesc& sensor : desc.meters) count += sensor.points.size() + 1;
    Progress progress("measure", "points", static_cast<double>(count), a.progress);
    const LightMeter meter(scene);
    std::vector<SensorReadings> all;
    std::size_t done = 0;
    const auto tell = [&] {
        if (!a.quiet) progress.update(static_cast<double>(++done) / static_cast<double>(count));
    };
    for (const MeterDesc& sensor : desc.meters) {
        SensorReadings& readings = all.emplace_back(SensorReadings{&sensor, {}, {}});
        for (const Point3& point : sensor.points) {
            Reading reading{point, {}, {}};
            if (const auto& surface = desc.water.surface)
                reading.depth = -glm::dot(point - surface->point, surface->normal);
            if (scene.water_surface && *reading.depth < 0)
                throw InputError(fmt::format(
                    "{}: it is {:.3g} m above water.surface, and meters are read in the water; "
                    "move it below",
                    sensor.where, -*reading.depth));
            reading.value = meter.read(point, sensor.up, a.rays);
            readings.readings.push_back(std::move(reading));
            tell();
        }
        readings.leaving = meter.read_water_leaving(sensor.points.front(), a.rays);
        tell();
    }
    return all;
}

std::string with_error(const MeteredSpectrum& value, std::size_t band) {
    if (!(value.mean[band] > 0)) return "0";
    return fmt::format("{:.4g} ±{:.2g}%", value.mean[band],
                       100 * value.error[band] / value.mean[band]);
}

std::string ratio_text(double over, double under) {
    return under > 0 ? fmt::format("{:.3g}", over / under) : "-";
}

Json per_band_json(const Spectrum& value, std::size_t bands) {
    Json list = Json::array();
    for (std::size_t b = 0; b < bands; ++b) list.push_back(value[b]);
    return list;
}

/// Adds what leaves the water to its sensor's report.
void report_leaving(const WaterLeaving& leaving, const std::vector<double>& bands, Report& sensor) {
    std::vector<std::vector<std::string>> rows{{"in the air", "nm", "Ed", "Lw", "Rrs 1/sr"}};
    for (std::size_t b = 0; b < bands.size(); ++b)
        rows.push_back({"", fmt::format("{:g}", bands[b]),
                        fmt::format("{:.4g}", leaving.irradiance[b]),
                        with_error(leaving.radiance, b), with_error(leaving.reflectance, b)});
    for (const std::string& row : aligned_rows(rows, 1)) sensor.say(row);
    const std::size_t count = bands.size();
    sensor.set({{"Ed_in_air", per_band_json(leaving.irradiance, count)},
                {"Lw", per_band_json(leaving.radiance.mean, count)},
                {"Lw_error", per_band_json(leaving.radiance.error, count)},
                {"Rrs", per_band_json(leaving.reflectance.mean, count)},
                {"Rrs_error", per_band_json(leaving.reflectance.error, count)}});
}

Report report_on(const std::vector<SensorReadings>& all, const std::vector<double>& bands) {
    Report report;
    std::vector<Report> sensors;
    for (const SensorReadings& of : all) {
        Report sensor(of.sensor->name);
        sensor.set({{"name", of.sensor->name}});
        std::vector<std::vector<std::string>> rows{
            {"depth m", "nm", "Ed", "Eu", "Eod", "Eou", "Lu", "R", "Kd 1/m"}};
        std::vector<Report> points;
        for (std::size_t i = 0; i < of.readings.size(); ++i) {
            const Reading& reading = of.readings[i];
            Report point;
            point.set({{"position", {reading.point.x, reading.point.y, reading.point.z}}});
            if (reading.depth) point.set({{"depth_m", *reading.depth}});
            for (const Quantity& quantity : k_quantities) {
                const MeteredSpectrum& value = reading.value.*quantity.value;
                point.set({{quantity.name, per_band_json(value.mean, bands.size())},
                           {std::string(quantity.name) + "_error",
                            per_band_json(value.error, bands.size())}});
            }
            Json slopes = Json::array();
            for (std::size_t b = 0; b < bands.size(); ++b) {
                const std::optional<double> slope = of.attenuation(i, b);
                slopes.push_back(slope ? Json(*slope) : Json(nullptr));
                const MeterReading& v = reading.value;
                rows.push_back({reading.depth ? fmt::format("{:.4g}", *reading.depth) : "-",
                                fmt::format("{:g}", bands[b]), with_error(v.down, b),
                                with_error(v.up, b), with_error(v.scalar_down, b),
                                with_error(v.scalar_up, b), with_error(v.radiance_up, b),
                                ratio_text(v.up.mean[b], v.down.mean[b]),
                                slope ? fmt::format("{:.4g}", *slope) : "-"});
            }
            point.set({{"Kd", slopes}});
            points.push_back(std::move(point));
        }
        for (const std::string& row : aligned_rows(rows, 0)) sensor.say(row);
        if (of.leaving) report_leaving(*of.leaving, bands, sensor);
        sensor.add("points", points);
        sensors.push_back(std::move(sensor));
    }
    report.set({{"bands_nm", bands}});
    report.add("sensors", sensors);
    return report;
}

std::string csv_of(const std::vector<SensorReadings>& all, const std::vector<double>& bands) {
    std::string text =
        "# plane and scalar irradiance in W/m2, radiance in W/(m2 sr), Kd in 1/m from the point "
        "before, Rrs in 1/sr at the surface above the first point\nsensor,x,y,z,depth_m,band_nm";
    for (const Quantity& quantity : k_quantities)
        text += fmt::format(",{0},{0}_error", quantity.name);
    text += ",Kd,Rrs,Rrs_error\n";
    for (const SensorReadings& of : all) {
        for (std::size_t i = 0; i < of.readings.size(); ++i) {
            const Reading& reading = of.readings[i];
            for (std::size_t b = 0; b < bands.size(); ++b) {
                text += fmt::format("{},{:.9g},{:.9g},{:.9g},{},{:g}", of.sensor->name,
                                    reading.point.x, reading.point.y, reading.point.z,
                                    reading.depth ? fmt::format("{:.9g}", *reading.depth) : "",
                                    bands[b]);
                for (const Quantity& quantity : k_quantities) {
                    const MeteredSpectrum& value = reading.value.*quantity.value;
                    text += fmt::format(",{:.6g},{:.3g}", value.mean[b], value.error[b]);
                }
                const std::optional<double> slope = of.attenuation(i, b);
                text += slope ? fmt::format(",{:.6g}", *slope) : ",";
                text += i == 0 && of.leaving
                            ? fmt::format(",{:.6g},{:.3g}\n", of.leaving->reflectance.mean[b],
                                          of.leaving->reflectance.error[b])
                            : ",,\n";
            }
        }
    }
    return text;
}

PlotFigure figure_of(const std::string& title, const std::vector<SensorReadings>& all,
                     const std::vector<double>& bands) {
    constexpr std::array k_colours{plot_colour::k_red,    plot_colour::k_green,
                                   plot_colour::k_blue,   plot_colour::k_orange,
                                   plot_colour::k_purple, plot_colour::k_sky};
    PlotFigure figure;
    figure.title = title;
    figure.caption = {
        "Solid: plane irradiance that travels down, Ed; dashed: up, Eu. In all light, by light "
        "paths."};
    for (const SensorReadings& of : all) {
        if (of.readings.size() < 2) continue;
        PlotPanel panel;
        panel.title = of.sensor->name;
        const bool has_depth = of.readings.front().depth.has_value();
        panel.x.label = has_depth ? "depth [m]" : "way along the line [m]";
        panel.y.label = "irradiance [W/m²]";
        panel.y.request.scale = AxisScale::log;
        for (std::size_t b = 0; b < bands.size(); ++b)
            for (const auto& [value, dashes] :
                 {std::pair{&MeterReading::down, ""}, std::pair{&MeterReading::up, "6 3"}}) {
                PlotCurve curve;
                if (*dashes == '\0') curve.label = fmt::format("{:g} nm", bands[b]);
                curve.colour = k_colours[b % k_colours.size()];
                curve.dashes = dashes;
                curve.markers = true;
                for (const Reading& reading : of.readings) {
                    curve.x.push_back(
                        reading.depth.value_or(distance(of.readings.front().point, reading.point)));
                    curve.y.push_back((reading.value.*value).mean[b]);
                }
                panel.curves.push_back(std::move(curve));
            }
        figure.panels.push_back(std::move(panel));
    }
    return figure;
}

void run_measure(const MeasureArguments& a) {
    const SceneDesc all = load_scene(a.scene, a.overrides);
    if (all.meters.empty())
        throw InputError(fmt::format(
            "{}: sensors: there are none; add sensors: [{{name: station, position: [0, -5, 0]}}]",
            all.file.filename().string()));
    check_outputs({a.csv, a.svg});
    Renderer renderer;
    renderer.set_scene(scene_of_image(all, {}));
    const AssembledScene& scene = renderer.assemble();
    for (const std::string& warning : scene.warnings)
        print_message(fmt::format("warning: {}\n", warning));
    std::vector<SensorReadings> readings;
    with_threads(a.threads, [&] { readings = read_all(a, scene); });
    const std::vector<double>& bands = scene.desc().water.bands_nm;
    TextFiles files;
    if (!a.csv.empty()) files.add(a.csv, csv_of(readings, bands));
    if (!a.svg.empty()) {
        const PlotFigure figure = figure_of(all.file.filename().string(), readings, bands);
        if (figure.panels.empty())
            throw UsageError(
                "--svg: plots lines of sensors, and this scene has none; give one from, to and "
                "count");
        files.add(a.svg, svg_document(figure));
    }
    files.commit();
    print_output(report_on(readings, bands).printed(a.json));
}

}  // namespace

Command measure_command() {
    const auto arguments = std::make_shared<MeasureArguments>();
    return {"measure", "read light meters in a scene's water", k_measure_examples,
            measure_options(*arguments), [arguments] {
                run_measure(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
