#include "cli/validate/validation_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cli/pages/html_page.h"
#include "cli/pages/svg_plot.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/image/colour.h"
#include "render/validation/validation_methods.h"

namespace uw {

namespace {

Verdict verdict_on(const Check& check) {
    if (!check.passed()) return Verdict::failed;
    return check.is_compared() ? Verdict::passed : Verdict::not_compared;
}

Verdict verdict_on(const LightCheck& check) {
    return check.passed() ? Verdict::passed : Verdict::failed;
}

ReportTable checks_of(const SceneValidation& scene) {
    ReportTable table{{"methods", "component", "band", "pixels", "largest", "RMS", "tolerance"}, 2};
    for (const Check& c : scene.checks)
        table.rows.push_back(
            {{c.left + " - " + c.right, c.component.name,
              fmt::format("{:g} nm", scene.bands_nm[c.band]), fmt::format("{}", c.pixels),
              c.is_compared() ? fmt::format("{:.4f} %", 100 * c.largest) : "-",
              fmt::format("{:.4f} %", 100 * c.rms), fmt::format("{:.3g} %", 100 * c.tolerance)},
             verdict_on(c)});
    return table;
}

/// What the verdict on a scene does not rest on; empty: nothing.
std::string left_uncompared(const SceneValidation& scene) {
    const auto count = std::ranges::count_if(
        scene.checks, [](const Check& check) { return !check.is_compared(); });
    if (count == 0) return "";
    return fmt::format(
        "{} of {} {} no pixel to compare, as an edge of shadow or beam crosses every ray: {} RMS "
        "is "
        "all that was checked",
        count, counted(scene.checks.size(), "row"), count == 1 ? "has" : "have",
        count == 1 ? "its" : "their");
}

ReportTable checks_of(const LightValidation& light) {
    ReportTable table{
        {"methods", "light", "deviation", "its error", "in errors", "RMS", "in errors", "worst"},
        2};
    for (const LightCheck& c : light.checks) {
        table.rows.push_back(
            {{c.left + " - " + c.right, c.light, fmt::format("{:+.3f} %", 100 * c.deviation),
              fmt::format("{:.3f} %", 100 * c.error),
              fmt::format("{:.1f}", c.deviation_in_errors()), "", "", ""},
             verdict_on(c)});
        if (!c.spread) continue;
        std::vector<std::string>& cells = table.rows.back().cells;
        cells[5] = fmt::format("{:.2f} %", 100 * c.spread->rms);
        cells[6] = fmt::format("{:.2f}", c.spread->rms_in_errors);
        cells[7] = fmt::format("{:.1f}", c.spread->worst_in_errors);
    }
    return table;
}

/// Which way the light took, per band.
ReportTable parts_of(const LightValidation& light) {
    ReportTable table{{"share of the light"}, 1};
    for (const double band : light.bands_nm) table.headings.push_back(fmt::format("{:g} nm", band));
    for (std::size_t part = 0; part < LightParts::k_names.size(); ++part) {
        ReportTable::Row& row =
            table.rows.emplace_back(ReportTable::Row{{LightParts::k_names[part]}});
        for (const LightParts& parts : light.parts)
            row.cells.push_back(fmt::format("{:.1f} %", 100 * parts.fraction(part)));
    }
    ReportTable::Row& row =
        table.rows.emplace_back(ReportTable::Row{{"all light / single scattering"}});
    for (const LightParts& parts : light.parts)
        row.cells.push_back(fmt::format("{:.3f}", parts.ratio()));
    return table;
}

// Deviations by check, in standard errors, between the limits.
std::string deviations_plot(const LightValidation& light) {
    PlotCurve points{"checks", {}, {}, plot_colour::k_blue, "", 0, true};
    PlotCurve above{"", {}, {}, plot_colour::k_orange, "6 3"}, below = above;
    above.label = fmt::format("limit: {:g}", LightCheck::k_max_errors);
    for (std::size_t i = 0; i < light.checks.size(); ++i) {
        const LightCheck& check = light.checks[i];
        const auto at = static_cast<double>(i + 1);
        points.x.push_back(at);
        points.y.push_back(check.error > 0 ? check.deviation / check.error : 0);
        for (PlotCurve* limit : {&above, &below}) limit->x.push_back(at);
        above.y.push_back(LightCheck::k_max_errors);
        below.y.push_back(-LightCheck::k_max_errors);
    }
    PlotPanel panel;
    panel.title = "Deviations";
    panel.x.label = "row of the table";
    panel.y.label = "standard errors";
    panel.curves = {points, above, below};
    PlotFigure figure;
    figure.panels = {panel};
    figure.columns = 1;
    return plot_html(figure);
}

std::string light_section(const LightValidation& light, const HtmlPictures& pictures) {
    std::string html =
        fmt::format("<h2>{}: {}</h2>\n<p>", light.name, verdict_html(light.passed()));
    for (const std::string& line : light.notes) html += xml_escaped(line) + ". ";
    html += fmt::format("{:.1f} s.</p>\n{}", light.seconds, checks_of(light).html());
    if (!light.parts.empty()) html += parts_of(light).html();
    for (const auto& [name, picture] : light.pictures) html += pictures.figure(picture, name);
    return html + deviations_plot(light);
}

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
    return plot_html(figure);
}

// One picture per method that has all of `components`; empty if none has.
std::string pictures_of(const SceneValidation& scene, const Components& components,
                        const std::string& title, HtmlPictures& pictures) {
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
                           HtmlPictures& pictures) {
    std::string html;
    for (const Check& check : scene.checks) {
        if (check.component.image != component.image || check.band != 0) continue;
        const DifferenceMap map = difference_map(scene, check);
        const std::string largest =
            check.is_compared() ? fmt::format("{:.2g} %", 100 * map.full_colour) : "not compared";
        html += pictures.figure(map.picture,
                                fmt::format("{} − {}: {}", check.left, check.right, largest));
    }
    return html.empty() ? html : fmt::format("<h4>{}</h4>\n{}", component.name, html);
}

std::string section_of(const SceneValidation& scene, HtmlPictures& pictures) {
    std::string html = fmt::format("<h2>{}: {}</h2>\n", scene.name, verdict_html(scene.passed()));
    const auto smooth = std::count(scene.smooth.begin(), scene.smooth.end(), char{1});
    html += fmt::format(
        "<p>{} × {} pixels; {:.0f} % of them without a shadow edge or hard beam edge in their ray. "
        "{:.1f} s."
        "</p>\n",
        scene.width, scene.height,
        100 * static_cast<double>(smooth) / static_cast<double>(scene.smooth.size()),
        scene.seconds);
    html += checks_of(scene).html();
    if (const std::string left = left_uncompared(scene); !left.empty())
        html += "<p>" + left + ".</p>\n";
    for (const std::string& line : scene.notes) html += "<p>" + xml_escaped(line) + ".</p>\n";
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

std::string light_table(const LightValidation& light, bool colour) {
    std::string text = fmt::format("{} ({:.1f} s)\n", light.name, light.seconds);
    for (const std::string& line : light.notes) text += "  " + line + "\n";
    text += checks_of(light).text(colour);
    return light.parts.empty() ? text : text + parts_of(light).text(colour);
}

std::string validation_table(const SceneValidation& scene, bool colour) {
    std::string text = fmt::format("{} ({} x {} pixels, {:.1f} s)\n", scene.name, scene.width,
                                   scene.height, scene.seconds);
    text += checks_of(scene).text(colour);
    if (const std::string left = left_uncompared(scene); !left.empty()) text += "  " + left + "\n";
    for (const std::string& line : scene.notes) text += "  " + line + "\n";
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

std::string validation_page(const std::vector<SceneValidation>& scenes,
                            const std::vector<LightValidation>& lights) {
    HtmlPictures pictures;
    std::string html = fmt::format(
        "<p>uwvdb {}. Every way of computing a scene against the others; tolerances are of the "
        "largest relative difference; the RMS may be three times the tolerance given.</p>\n",
        program_version());
    for (const SceneValidation& scene : scenes) html += section_of(scene, pictures);
    for (const LightValidation& light : lights) html += light_section(light, pictures);
    return html_page("uwvdb validate", html);
}

}  // namespace uw
