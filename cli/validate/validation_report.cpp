#include "cli/validate/validation_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "cli/plot/svg_plot.h"
#include "cli/validate/image_differences.h"
#include "cli/validate/light_report.h"
#include "cli/validate/report_page.h"
#include "core/base/error.h"
#include "core/base/version.h"
#include "core/colour/colour.h"
#include "core/files/atomic_file.h"

namespace uw {

namespace {

using Components = std::vector<Component>;
const Components k_before{k_direct, k_backscatter};
const Components k_scattered{k_direct, k_forward, k_blurred_backscatter};

// The sum of `components` in one pixel.
Spectrum sum_of(const MethodImage& image, const Components& components, std::size_t pixel) {
    Spectrum sum{};
    for (const Component& component : components) sum += (image.*component.image)[pixel];
    return sum;
}

Preview picture_of(const SceneValidation& scene, const MethodImage& image,
                   const Components& components, double exposure) {
    const BandColour colour(scene.bands_nm);
    Preview picture(scene.width, scene.height);
    for (std::size_t i = 0; i < scene.smooth.size(); ++i) {
        const LinearRgb rgb = colour(sum_of(image, components, i));
        for (std::size_t c = 0; c < 3; ++c) picture[i][c] = srgb_bytes()(exposure * rgb[c]);
    }
    return picture;
}

double exposure_of(const SceneValidation& scene, const MethodImage& image,
                   const Components& components) {
    std::vector<double> values;
    for (std::size_t i = 0; i < scene.smooth.size(); ++i) {
        const Spectrum sum = sum_of(image, components, i);
        for (std::size_t b = 0; b < scene.bands_nm.size(); ++b) values.push_back(sum[b]);
    }
    std::sort(values.begin(), values.end());
    const double bright = values.empty() ? 0 : values[values.size() * 98 / 100];
    return bright > 0 ? 0.8 / bright : 1;
}

/// The relative differences of one component, in the band that differs most at each pixel.
struct DifferenceMap {
    Preview picture;
    double full_colour = 0;  // the difference that is shown in full colour
};

// Blue where `left` is darker, red where it is brighter; grey where a shadow edge or hard beam edge
// crosses the ray of a method that steps over it.
DifferenceMap difference_map(const SceneValidation& scene, const Check& check) {
    const std::vector<Spectrum>& a = scene.images.at(check.left).*check.component.image;
    const std::vector<Spectrum>& b = scene.images.at(check.right).*check.component.image;
    const auto counts = [&](std::size_t i) { return check.everywhere || scene.smooth[i] != 0; };
    std::vector<double> worst(a.size());
    DifferenceMap map{Preview(scene.width, scene.height), 0};
    for (std::size_t band = 0; band < scene.bands_nm.size(); ++band) {
        const double dark = check.dark * mean_over_pixels(b, band);
        for (std::size_t i = 0; i < a.size(); ++i) {
            const double reference = std::max(b[i][band], dark);
            const double d = reference > 0 ? (a[i][band] - b[i][band]) / reference : 0;
            if (std::abs(d) > std::abs(worst[i])) worst[i] = d;
            if (counts(i)) map.full_colour = std::max(map.full_colour, std::abs(worst[i]));
        }
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double strength = worst[i] == 0 ? 0 : std::abs(worst[i]) / map.full_colour;
        const auto fade = static_cast<std::uint8_t>(255 * (1 - std::min(1.0, strength)));
        if (!counts(i))
            map.picture[i] = {190, 190, 190};
        else if (worst[i] > 0)
            map.picture[i] = {255, fade, fade};
        else
            map.picture[i] = {fade, fade, 255};
    }
    return map;
}

// A colour bar from blue over white to red, as in the maps.
constexpr const char* k_colour_scale =
    "<p><span style=\"display:inline-block;width:12em;height:1em;border:1px solid #ccc;background:"
    "linear-gradient(90deg,#00f,#fff,#f00)\"></span> the first is darker … the same … brighter; "
    "full colour at the largest difference, which is given below each map. Grey: a shadow edge or "
    "hard beam edge crosses the ray of a method that steps over it.</p>\n";

std::string table_of(const SceneValidation& scene) {
    std::string html =
        "<table><tr><th>methods</th><th>component</th><th>band</th><th>pixels</th><th>largest</th>"
        "<th>RMS</th><th>tolerance</th><th></th></tr>\n";
    for (const Check& c : scene.checks)
        html += fmt::format(
            "<tr><td>{} ↔ {}</td><td>{}</td><td class=n>{:g} nm</td><td class=n>{}</td>"
            "<td class=n>{:.4f} %</td><td class=n>{:.4f} %</td><td class=n>{:.3g} %</td><td "
            "class={}>{}</td></tr>\n",
            c.left, c.right, c.component.name, scene.bands_nm[c.band], c.pixels, 100 * c.largest,
            100 * c.rms, 100 * c.tolerance, c.passed() ? "passed" : "failed",
            c.passed() ? "passed" : "FAILED");
    return html + "</table>\n";
}

std::string convergence_plot(const SceneValidation& scene) {
    PlotCurve measured{"largest difference", {}, {}, plot_colour::k_blue, "", 1.8, true};
    PlotCurve second_order{"1/N²", {}, {}, plot_colour::k_orange, "6 3", 1.8, false};
    for (const PlanesStep& step : scene.planes) {
        measured.x.push_back(step.count);
        measured.y.push_back(step.error);
        second_order.x.push_back(step.count);
        second_order.y.push_back(scene.planes.front().error *
                                 std::pow(scene.planes.front().count / double(step.count), 2));
    }
    PlotPanel panel;
    panel.title = "Planes against their limit";
    panel.x.label = "number of slabs N";
    panel.y.label = "relative difference";
    panel.x.request.scale = panel.y.request.scale = AxisScale::log;
    panel.curves = {measured, second_order};
    PlotFigure figure;
    figure.panels = {panel};
    figure.columns = 1;
    return svg_document(figure);
}

// One picture per method that has all of `components`; empty if none has.
std::string pictures_of(const SceneValidation& scene, const Components& components,
                        const std::string& title, ReportPictures& pictures) {
    std::string html;
    double exposure = 0;
    for (const auto& [name, image] : scene.images) {
        const auto told = [&image = image](const Component& c) {
            return !(image.*c.image).empty();
        };
        if (!std::all_of(components.begin(), components.end(), told)) continue;
        if (html.empty()) exposure = exposure_of(scene, image, components);
        html += pictures.figure(picture_of(scene, image, components, exposure), name);
    }
    return html.empty() ? html : fmt::format("<h3>{}</h3>\n{}", title, html);
}

std::string differences_of(const SceneValidation& scene, const Component& component,
                           ReportPictures& pictures) {
    std::string html;
    for (const Check& check : scene.checks) {
        if (check.component.image != component.image || check.band != 0) continue;
        const DifferenceMap map = difference_map(scene, check);
        html += pictures.figure(map.picture, fmt::format("{} − {}: {:.2g} %", check.left,
                                                         check.right, 100 * map.full_colour));
    }
    return html.empty() ? html : fmt::format("<h4>{}</h4>\n{}", component.name, html);
}

std::string section_of(const SceneValidation& scene, ReportPictures& pictures) {
    std::string html = fmt::format("<h2>{}: {}</h2>\n", scene.name, verdict_html(scene.passed()));
    const auto smooth = std::count(scene.smooth.begin(), scene.smooth.end(), char{1});
    html += fmt::format(
        "<p>{} × {} pixels; {:.0f} % of them without a shadow edge or hard beam edge in their ray. "
        "{:.1f} s."
        "</p>\n",
        scene.width, scene.height,
        100 * static_cast<double>(smooth) / static_cast<double>(scene.smooth.size()),
        scene.seconds);
    html += table_of(scene);
    html += pictures_of(scene, k_before, "Pictures", pictures);
    html += pictures_of(scene, k_scattered, "Pictures with forward scatter", pictures);
    html +=
        pictures_of(scene, {k_forward}, "What forward scatter adds to the direct light", pictures);
    html += "<h3>Differences</h3>\n";
    html += k_colour_scale;
    for (const Component& component : {k_backscatter, k_forward, k_blurred_backscatter})
        html += differences_of(scene, component, pictures);
    html += "<h3>Convergence</h3>\n";
    return html + convergence_plot(scene);
}

// The most that a method may itself be off by.
double own_error(const SceneValidation& scene) {
    double own = 0;
    for (const Check& check : scene.checks) own = std::max(own, check.own);
    return own;
}

}  // namespace

std::string validation_table(const SceneValidation& scene, bool colour) {
    std::string text = fmt::format("{} ({} x {} pixels, {:.1f} s)\n", scene.name, scene.width,
                                   scene.height, scene.seconds);
    text += fmt::format("  {:<44} {:<20} {:>8} {:>7} {:>11} {:>11} {:>9}\n", "methods", "component",
                        "band", "pixels", "largest", "RMS", "tolerance");
    for (const Check& c : scene.checks) {
        const std::string line = fmt::format(
            "  {:<44} {:<20} {:>5g} nm {:>7} {:>9.4f} % {:>9.4f} % {:>7.3g} %  {}",
            c.left + " - " + c.right, c.component.name, scene.bands_nm[c.band], c.pixels,
            100 * c.largest, 100 * c.rms, 100 * c.tolerance, c.passed() ? "passed" : "FAILED");
        text += colour && !c.passed() ? "\033[31m" + line + "\033[0m\n" : line + "\n";
    }
    text += "  planes against their limit:";
    for (const PlanesStep& step : scene.planes)
        text += step.order == 0 ? fmt::format(" N={} {:.2g}", step.count, step.error)
                                : fmt::format(", N={} {:.2g} (order {:.2f})", step.count,
                                              step.error, step.order);
    text += "\n";
    const double own = own_error(scene);
    if (own > 0)
        text += fmt::format(
            "  the sums over planes still change by {:.2g} %, which is allowed beside the "
            "tolerance: narrow light or shadow edges cross the rays\n",
            100 * own);
    return text;
}

void write_validation_report(const std::filesystem::path& file,
                             const std::vector<SceneValidation>& scenes,
                             const std::vector<LightValidation>& lights) {
    ReportPictures pictures;
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>uwvdb validate"
        "</title><style>{}</style></head><body>\n<h1>uwvdb validate</h1>\n<p>uwvdb {}. Every way "
        "of computing a scene against the others; tolerances are of the largest relative "
        "difference; the RMS may be three times the tolerance given.</p>\n",
        k_report_style, program_version());
    for (const SceneValidation& scene : scenes) html += section_of(scene, pictures);
    for (const LightValidation& light : lights) html += light_section(light, pictures);
    html += "</body></html>\n";
    AtomicFile target(file);
    std::ofstream out(target.temporary_path(), std::ios::binary);
    out << html;
    out.close();
    if (!out) throw IoError(fmt::format("{}: cannot write; is the disk full?", file.string()));
    target.commit();
}

}  // namespace uw
