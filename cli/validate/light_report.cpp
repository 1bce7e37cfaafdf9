#include "cli/validate/light_report.h"

#include <fmt/format.h>

#include "cli/plot/svg_plot.h"

namespace uw {

namespace {

// "0.42 %, 0.8 errors of 1.2 at worst" is too long for a table: columns by themselves.
std::string spread_text(const LightCheck& check) {
    if (!check.spread) return fmt::format("{:>9} {:>9} {:>9}", "", "", "");
    const PixelSpread& spread = *check.spread;
    return fmt::format("{:>7.2f} % {:>9.2f} {:>9.1f}", 100 * spread.rms, spread.rms_in_errors,
                       spread.worst_in_errors);
}

std::string spread_cells(const LightCheck& check) {
    if (!check.spread) return "<td></td><td></td><td></td>";
    const PixelSpread& spread = *check.spread;
    return fmt::format("<td class=n>{:.2f} %</td><td class=n>{:.2f}</td><td class=n>{:.1f}</td>",
                       100 * spread.rms, spread.rms_in_errors, spread.worst_in_errors);
}

std::string table_html(const LightValidation& light) {
    std::string html =
        "<table><tr><th>methods</th><th>light</th><th>deviation</th><th>its error</th>"
        "<th>in errors</th><th>RMS</th><th>in errors</th><th>worst</th><th></th></tr>\n";
    for (const LightCheck& c : light.checks)
        html += fmt::format(
            "<tr><td>{} ↔ {}</td><td>{}</td><td class=n>{:+.3f} %</td><td class=n>{:.3f} %</td>"
            "<td class=n>{:.1f}</td>{}<td>{}</td></tr>\n",
            c.left, c.right, c.light, 100 * c.deviation, 100 * c.error, c.deviation_in_errors(),
            spread_cells(c), verdict_html(c.passed()));
    return html + "</table>\n";
}

std::string parts_html(const LightValidation& light) {
    std::string html = "<table><tr><th>share of the light</th>";
    for (const double band : light.bands_nm) html += fmt::format("<th>{:g} nm</th>", band);
    html += "</tr>\n";
    for (std::size_t part = 0; part < LightParts::k_names.size(); ++part) {
        html += fmt::format("<tr><td>{}</td>", LightParts::k_names[part]);
        for (const LightParts& parts : light.parts)
            html += fmt::format("<td class=n>{:.1f} %</td>", 100 * parts.share(part));
        html += "</tr>\n";
    }
    html += "<tr><td>all light / single scattering</td>";
    for (const LightParts& parts : light.parts)
        html += fmt::format("<td class=n>{:.3f}</td>", parts.ratio());
    return html + "</tr></table>\n";
}

// Deviations by check, in standard errors, between the limits.
std::string deviations_svg(const LightValidation& light) {
    PlotCurve points{"checks", {}, {}, plot_colour::k_blue, "", 0, true};
    PlotCurve above{"", {}, {}, plot_colour::k_orange, "6 3"}, below = above;
    above.label = fmt::format("limit: {:g}", LightCheck::k_most_errors);
    for (std::size_t i = 0; i < light.checks.size(); ++i) {
        const LightCheck& check = light.checks[i];
        const auto at = static_cast<double>(i + 1);
        points.x.push_back(at);
        points.y.push_back(check.error > 0 ? check.deviation / check.error : 0);
        for (PlotCurve* limit : {&above, &below}) limit->x.push_back(at);
        above.y.push_back(LightCheck::k_most_errors);
        below.y.push_back(-LightCheck::k_most_errors);
    }
    PlotPanel panel;
    panel.title = "Deviations";
    panel.x.label = "row of the table";
    panel.y.label = "standard errors";
    panel.curves = {points, above, below};
    PlotFigure figure;
    figure.panels = {panel};
    figure.columns = 1;
    return svg_document(figure);
}

}  // namespace

std::string light_table(const LightValidation& light, bool colour) {
    std::string text = fmt::format("{} ({:.1f} s)\n", light.name, light.seconds);
    for (const std::string& line : light.notes) text += "  " + line + "\n";
    text +=
        fmt::format("  {:<16} {:<32} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "methods", "light",
                    "deviation", "its error", "in errors", "RMS", "in errors", "worst");
    for (const LightCheck& c : light.checks) {
        const std::string line =
            fmt::format("  {:<16} {:<32} {:>+8.3f} % {:>7.3f} % {:>9.1f} {}  {}",
                        c.left + " - " + c.right, c.light, 100 * c.deviation, 100 * c.error,
                        c.deviation_in_errors(), spread_text(c), c.passed() ? "passed" : "FAILED");
        text += colour && !c.passed() ? "\033[31m" + line + "\033[0m\n" : line + "\n";
    }
    for (std::size_t b = 0; b < light.parts.size(); ++b) {
        text += fmt::format("  {:g} nm:", light.bands_nm[b]);
        for (std::size_t part = 0; part < LightParts::k_names.size(); ++part)
            text += fmt::format(" {} {:.1f} %,", LightParts::k_names[part],
                                100 * light.parts[b].share(part));
        text += fmt::format(" all light / single scattering {:.3f}\n", light.parts[b].ratio());
    }
    return text;
}

std::string light_section(const LightValidation& light, const ReportPictures& pictures) {
    std::string html =
        fmt::format("<h2>{}: {}</h2>\n<p>", light.name, verdict_html(light.passed()));
    for (const std::string& line : light.notes) html += line + ". ";
    html += fmt::format("{:.1f} s.</p>\n{}", light.seconds, table_html(light));
    if (!light.parts.empty()) html += parts_html(light);
    for (const auto& [name, picture] : light.pictures) html += pictures.figure(picture, name);
    return html + deviations_svg(light);
}

}  // namespace uw
