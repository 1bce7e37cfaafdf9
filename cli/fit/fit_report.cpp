#include "cli/fit/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cli/svg_plot.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "core/base/version.h"

namespace uw {

namespace {

std::string with_unit(const std::string& number, const SceneUnknown& unknown) {
    return unknown.unit.empty() ? number : number + " " + unknown.unit;
}

/// A number with the digits that its error leaves meaning in.
std::string to_its_error(double value, double error) {
    if (!std::isfinite(error) || !(error > 0)) return fmt::format("{:.6g}", value);
    const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 12);
    return fmt::format("{:.{}f}", value, decimals);
}

std::string error_text(const FoundValue& found) {
    return std::isfinite(found.error) ? fmt::format("{:.2g}", found.error) : "not determined";
}

std::vector<std::vector<std::string>> value_rows(const FitResult& result) {
    std::vector<std::vector<std::string>> rows{{"unknown", "start", "found", "± error", ""}};
    for (const FoundValue& found : result.values)
        rows.push_back({found.unknown.name, fmt::format("{:.6g}", found.unknown.start),
                        with_unit(to_its_error(found.value, found.error), found.unknown),
                        error_text(found), found.is_at_bound ? "at its bound" : ""});
    return rows;
}

/// The length of a point's residual [pixels].
double length_of(const FitResult& result, std::size_t point) {
    return std::hypot(result.residuals[2 * point], result.residuals[2 * point + 1]);
}

struct ImageSummary {
    std::size_t points = 0, outliers = 0;
    double squares = 0, greatest = 0;

    double rms() const {
        return points > outliers ? std::sqrt(squares / static_cast<double>(points - outliers)) : 0;
    }
};

std::vector<ImageSummary> summaries(const PointResiduals& points, const FitResult& result) {
    std::vector<ImageSummary> images(points.seen().images.size());
    for (std::size_t i = 0; i < points.seen().points.size(); ++i) {
        ImageSummary& image = images[points.seen().points[i].image];
        ++image.points;
        if (result.outliers[i]) {
            ++image.outliers;
            continue;
        }
        const double length = length_of(result, i);
        image.squares += length * length;
        image.greatest = std::max(image.greatest, length);
    }
    return images;
}

/// Of a point, in both coordinates together.
double of_points(double per_coordinate) {
    return std::numbers::sqrt2 * per_coordinate;
}

std::string summary_line(const PointResiduals& points, const FitResult& result) {
    const auto outliers = static_cast<std::size_t>(std::ranges::count(result.outliers, true));
    std::string line = fmt::format("{} in {}: RMS {:.4g} px, {:.4g} px at the start",
                                   counted(result.outliers.size(), "point"),
                                   counted(points.seen().images.size(), "image"),
                                   of_points(result.rms), of_points(result.rms_at_start));
    if (outliers > 0)
        line += fmt::format("; {} left out, {:.4g} px with them", counted(outliers, "outlier"),
                            of_points(result.rms_with_outliers));
    return line;
}

}  // namespace

std::vector<std::string> doubts(const FitResult& result) {
    std::vector<std::string> all;
    if (!result.converged)
        all.push_back(
            "The fit has not converged: the values are the best so far. Begin nearer (--set), fix "
            "some of the unknowns, or try several --starts.");
    const auto name_of = [&](std::size_t i) { return result.values[i].unknown.name; };
    for (const FreeDirection& direction : result.free_directions) {
        const std::string certain =
            std::isfinite(direction.error)
                ? fmt::format("to {:.2g} times their size at best", direction.error)
                : "at all";
        if (direction.unknowns.size() == 1) {
            all.push_back(
                fmt::format("{} is not determined {}: leave it out, or give a --prior.",
                            name_of(direction.unknowns.front()),
                            std::isfinite(direction.error) ? certain : "by these observations"));
            continue;
        }
        std::vector<std::string> names;
        for (const std::size_t i : direction.unknowns) names.push_back(name_of(i));
        const std::string last = names.back();
        names.pop_back();
        all.push_back(fmt::format(
            "{} and {} cannot be told apart {}: leave one out, or give it a --prior.",
            fmt::join(names, ", "), last, std::isfinite(direction.error) ? certain : "at all"));
    }
    const std::size_t n = result.values.size();
    constexpr double k_strong = 0.95;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            const double correlation = result.correlations[i * n + j];
            if (std::abs(correlation) > k_strong)
                all.push_back(fmt::format(
                    "{} and {} are correlated by {:.3f}: an error of one is made up for by the "
                    "other.",
                    name_of(i), name_of(j), correlation));
        }
    for (const FoundValue& found : result.values)
        if (found.is_at_bound)
            all.push_back(
                fmt::format("{} ended at its bound, {:.6g}: its standard error says nothing.",
                            found.unknown.name, found.value));
    return all;
}

FitReport::FitReport(const PointResiduals& points, const FitResult& result)
    : points_(points), result_(result) {}

std::string FitReport::printed(bool as_json) const {
    Report report;
    report.say(summary_line(points_, result_));
    report.set({{"rms_px", of_points(result_.rms)},
                {"rms_with_outliers_px", of_points(result_.rms_with_outliers)},
                {"rms_at_start_px", of_points(result_.rms_at_start)},
                {"deviation_px", result_.deviation},
                {"converged", result_.converged},
                {"iterations", result_.iterations},
                {"points", result_.outliers.size()},
                {"outliers", std::ranges::count(result_.outliers, true)}});
    std::vector<Report> values;
    for (const FoundValue& found : result_.values) {
        Report value;
        value.set({{"name", found.unknown.name},
                   {"unit", found.unknown.unit},
                   {"start", found.unknown.start},
                   {"value", found.value},
                   {"error", std::isfinite(found.error) ? Json(found.error) : Json(nullptr)},
                   {"at_bound", found.is_at_bound}});
        values.push_back(std::move(value));
    }
    for (const std::string& row : aligned_rows(value_rows(result_), 1)) report.say(row);
    report.add("unknowns", values);
    const std::vector<std::string> all_doubts = doubts(result_);
    for (const std::string& doubt : all_doubts) report.say(doubt);
    report.set({{"doubts", all_doubts}});
    std::vector<Report> images;
    const std::vector<ImageSummary> all = summaries(points_, result_);
    for (std::size_t i = 0; i < all.size(); ++i) {
        Report image;
        image.set({{"name", points_.seen().images[i]},
                   {"points", all[i].points},
                   {"outliers", all[i].outliers},
                   {"rms_px", all[i].rms()},
                   {"greatest_px", all[i].greatest}});
        images.push_back(std::move(image));
    }
    report.add("images", images);
    return report.printed(as_json);
}

std::string FitReport::csv() const {
    std::string text = "image,x,y,z,u,v,du,dv,outlier\n";
    for (std::size_t i = 0; i < points_.seen().points.size(); ++i) {
        const SeenPoint& point = points_.seen().points[i];
        text +=
            fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{}\n",
                        csv_text(points_.seen().images[point.image]), point.point.x, point.point.y,
                        point.point.z, point.seen.x, point.seen.y, result_.residuals[2 * i],
                        result_.residuals[2 * i + 1], result_.outliers[i] ? 1 : 0);
    }
    return text;
}

std::string FitReport::page(const std::string& scene) const {
    const auto table = [](const std::vector<std::vector<std::string>>& rows) {
        std::string html = "<table>";
        for (std::size_t r = 0; r < rows.size(); ++r) {
            html += "<tr>";
            for (std::size_t c = 0; c < rows[r].size(); ++c)
                html += fmt::format("<{0}{1}>{2}</{0}>", r == 0 ? "th" : "td",
                                    c > 0 && r > 0 ? " class=n" : "", xml_escaped(rows[r][c]));
            html += "</tr>\n";
        }
        return html + "</table>\n";
    };
    std::string html = fmt::format(
        "<!doctype html><html lang=en><meta charset=utf-8><title>{0}</title><style>"
        "body{{font:15px/1.5 system-ui,sans-serif;max-width:1000px;margin:2em "
        "auto;padding:0 1em;color:#222}}table{{border-collapse:collapse;margin:1em "
        "0}}td,th{{padding:.15em .8em;border-bottom:1px solid "
        "#ddd;text-align:left}}td.n{{text-align:right;white-space:nowrap;"
        "font-variant-numeric:tabular-nums}}</style>\n<h1>Fit of {0}</h1>\n<p>{1}.</p>\n",
        xml_escaped(scene), xml_escaped(summary_line(points_, result_)));
    html += "<h2>What was found</h2>\n" + table(value_rows(result_));
    html += fmt::format(
        "<p>Errors are standard errors, from how the residuals of these {} spread ({:.3g} px per "
        "coordinate).</p>\n",
        counted(result_.outliers.size(), "point"), result_.deviation);
    const std::vector<std::string> all_doubts = doubts(result_);
    html += "<h2>What these observations cannot tell</h2>\n";
    if (all_doubts.empty()) html += "<p>Each unknown is determined by itself.</p>\n";
    for (const std::string& doubt : all_doubts)
        html += fmt::format("<p>{}</p>\n", xml_escaped(doubt));

    PlotFigure figure;
    figure.title = "Residuals";
    figure.caption = {
        "Left: where a point is predicted less where it was seen. Right: from where it was seen "
        "in the image, 100 times as long. Orange: left out."};
    PlotPanel scatter, arrows;
    scatter.title = "By coordinate";
    scatter.x.label = "du [px]";
    scatter.y.label = "dv [px]";
    arrows.title = "In the image";
    arrows.x.label = "x [px]";
    arrows.y.label = "height above the image's bottom [px]";
    PlotCurve kept, left_out;
    kept.colour = plot_colour::k_blue;
    left_out.colour = plot_colour::k_orange;
    kept.width = left_out.width = 0;
    kept.markers = left_out.markers = true;
    PlotCurve lines;
    lines.colour = plot_colour::k_blue;
    lines.width = 1;
    double bottom = 0;
    for (const SeenPoint& point : points_.seen().points) bottom = std::max(bottom, point.seen.y);
    for (std::size_t i = 0; i < points_.seen().points.size(); ++i) {
        const double du = result_.residuals[2 * i], dv = result_.residuals[2 * i + 1];
        PlotCurve& curve = result_.outliers[i] ? left_out : kept;
        curve.x.push_back(du);
        curve.y.push_back(dv);
        if (result_.outliers[i]) continue;
        constexpr double k_enlarged = 100;
        const ImagePoint& seen = points_.seen().points[i].seen;
        lines.x.insert(lines.x.end(), {seen.x, seen.x + k_enlarged * du, std::nan("")});
        lines.y.insert(lines.y.end(),
                       {bottom - seen.y, bottom - seen.y - k_enlarged * dv, std::nan("")});
    }
    scatter.curves = {kept, left_out};
    arrows.curves = {lines};
    figure.panels = {scatter, arrows};
    html += "<h2>Residuals</h2>\n" + svg_document(figure);

    std::vector<std::vector<std::string>> rows{
        {"image", "points", "left out", "RMS [px]", "greatest [px]"}};
    const std::vector<ImageSummary> images = summaries(points_, result_);
    for (std::size_t i = 0; i < images.size(); ++i)
        rows.push_back({points_.seen().images[i], std::to_string(images[i].points),
                        std::to_string(images[i].outliers), fmt::format("{:.3f}", images[i].rms()),
                        fmt::format("{:.3f}", images[i].greatest)});
    html += table(rows);
    html += fmt::format("<p>uwvdb {}</p>\n</html>\n", xml_escaped(program_version()));
    return html;
}

}  // namespace uw
