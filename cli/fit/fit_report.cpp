#include "cli/fit/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "cli/pages/html_page.h"
#include "cli/pages/svg_plot.h"
#include "core/base/csv_table.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/image/colour.h"

namespace uw {

namespace {

std::string with_unit(const std::string& number, const SceneUnknown& unknown) {
    return unknown.unit.empty() ? number : number + " " + unknown.unit;
}

/// A number with its significant digits, by its error.
std::string to_its_error(double value, double error) {
    if (!std::isfinite(error) || !(error > 0)) return fmt::format("{:.6g}", value);
    const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 12);
    return fmt::format("{:.{}f}", value, decimals);
}

std::string error_text(double error) {
    return std::isfinite(error) ? fmt::format("{:.2g}", error) : "not determined";
}

/// How well the camera's poses were found, in a sentence.
std::string pose_line(std::span<const FoundPose> poses) {
    double metres = 0, degrees = 0;
    for (const FoundPose& pose : poses) {
        metres = std::max(metres, glm::length(pose.position_error));
        degrees = std::max(degrees, glm::length(pose.turn_error));
    }
    if (!std::isfinite(metres)) return "The camera's poses are not all determined.";
    return fmt::format("The camera's poses are known to {:.2g} mm and {:.2g} degrees, or better.",
                       1e3 * metres, degrees);
}

std::vector<std::vector<std::string>> value_rows(const FitResult& result) {
    std::vector<std::vector<std::string>> rows{{"unknown", "start", "found", "± error", ""}};
    for (const FoundValue& found : result.values)
        rows.push_back({found.unknown.name, fmt::format("{:.6g}", found.unknown.start),
                        with_unit(to_its_error(found.value, found.error), found.unknown),
                        error_text(found.error), found.is_at_bound ? "at its bound" : ""});
    return rows;
}

/// The residuals of each group, and what they amount to together.
class Groups {
  public:
    Groups(const Observations& observations, const FitResult& result) : result_(result) {
        std::size_t first = 0;
        for (const ResidualGroup& group : observations.groups()) {
            first_.push_back(first);
            first += static_cast<std::size_t>(group.residuals);
        }
        first_.push_back(first);
    }
    std::span<const double> of(std::size_t group) const {
        return std::span(result_.residuals)
            .subspan(first_[group], first_[group + 1] - first_[group]);
    }
    double squares(std::size_t group) const {
        double sum = 0;
        for (const double residual : of(group)) sum += residual * residual;
        return sum;
    }
    std::size_t size() const { return first_.size() - 1; }

  private:
    const FitResult& result_;
    std::vector<std::size_t> first_;
};

struct ImageSummary {
    std::size_t groups = 0, outliers = 0, residuals = 0;
    double squares = 0;
};

std::vector<ImageSummary> summaries(const Observations& observations, const FitResult& result) {
    std::vector<ImageSummary> images(observations.images().size());
    const Groups groups(observations, result);
    for (std::size_t i = 0; i < groups.size(); ++i) {
        ImageSummary& image = images[observations.place(i).image];
        ++image.groups;
        if (result.outliers[i]) {
            ++image.outliers;
            continue;
        }
        image.squares += groups.squares(i);
        image.residuals += groups.of(i).size();
    }
    return images;
}

double rms_of(const ImageSummary& image, const Observations& observations) {
    if (image.residuals == 0) return 0;
    return observations.of_group(std::sqrt(image.squares / static_cast<double>(image.residuals)));
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
                ? fmt::format("to better than {:.2g} times their size", direction.error)
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
        all.push_back(
            fmt::format("{} and {} cannot be told apart {}: leave one out, or give it a --prior.",
                        fmt::join(names, ", "), last, certain));
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

FitReport::FitReport(const Observations& observations, const PictureResiduals* pictures,
                     const FitResult& result, std::vector<FoundPose> poses,
                     std::vector<std::string> questions)
    : observations_(observations),
      pictures_(pictures),
      result_(result),
      poses_(std::move(poses)),
      doubts_(std::move(questions)) {
    for (std::string& doubt : doubts(result_)) doubts_.push_back(std::move(doubt));
}

std::string FitReport::summary_line() const {
    const auto outliers = static_cast<std::size_t>(std::ranges::count(result_.outliers, true));
    const auto rms = [&](double per_number) {
        return fmt::format("{:.4g} {}", observations_.of_group(per_number), observations_.unit());
    };
    std::string line = fmt::format("{} in {}: RMS {}, {} at the start",
                                   counted(result_.outliers.size(), observations_.noun()),
                                   counted(observations_.images().size(), "image"),
                                   rms(result_.rms), rms(result_.rms_at_start));
    if (pictures_ != nullptr)
        line += fmt::format("; {:.2g} % of the light", 100 * pictures_->relative_rms(result_));
    if (outliers > 0)
        line += fmt::format("; {} left out, {} with them", counted(outliers, "outlier"),
                            rms(result_.rms_with_outliers));
    return line;
}

std::string FitReport::printed(bool as_json) const {
    Report report;
    report.say(summary_line());
    report.set({{"observed", observations_.noun()},
                {"unit", observations_.unit()},
                {"rms", observations_.of_group(result_.rms)},
                {"rms_with_outliers", observations_.of_group(result_.rms_with_outliers)},
                {"rms_at_start", observations_.of_group(result_.rms_at_start)},
                {"deviation", result_.deviation},
                {"clustering", result_.clustering},
                {"converged", result_.converged},
                {"iterations", result_.iterations},
                {"observations", result_.outliers.size()},
                {"outliers", std::ranges::count(result_.outliers, true)}});
    if (pictures_ != nullptr) report.set({{"relative_rms", pictures_->relative_rms(result_)}});
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
    report.set({{"correlations", result_.correlations}});
    if (!poses_.empty()) report.say(pose_line(poses_));
    for (const std::string& doubt : doubts_) report.say(doubt);
    report.set({{"doubts", doubts_}});
    std::vector<Report> images;
    const std::vector<ImageSummary> all = summaries(observations_, result_);
    for (std::size_t i = 0; i < all.size(); ++i) {
        Report image;
        image.set({{"name", observations_.images()[i]},
                   {"observations", all[i].groups},
                   {"outliers", all[i].outliers},
                   {"rms", rms_of(all[i], observations_)}});
        if (!poses_.empty()) {
            const FoundPose& pose = poses_[i];
            image.set({{"position", vector_json(pose.world_from_camera.offset())},
                       {"position_error", vector_json(pose.position_error)},
                       {"turn_error", vector_json(pose.turn_error)}});
        }
        images.push_back(std::move(image));
    }
    report.add("images", images);
    return report.printed(as_json);
}

std::string FitReport::csv() const {
    const Groups groups(observations_, result_);
    std::size_t most = 0;
    for (std::size_t i = 0; i < groups.size(); ++i) most = std::max(most, groups.of(i).size());
    std::string text = "image,u,v";
    for (std::size_t k = 0; k < most; ++k) text += fmt::format(",residual_{}", k);
    text += ",outlier\n";
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const Observations::Place place = observations_.place(i);
        text += fmt::format("{},{:.9g},{:.9g}", csv_text(observations_.images()[place.image]),
                            place.at.x, place.at.y);
        for (const double residual : groups.of(i)) text += fmt::format(",{:.6g}", residual);
        text += result_.outliers[i] ? ",1\n" : ",0\n";
    }
    return text;
}

/// Residual vectors of points, by their components and where they are in the image.
PlotFigure FitReport::residual_figure() const {
    PlotFigure figure;
    figure.caption = {
        "Left: where a point is predicted less where it was seen. Right: from where it was seen "
        "in the image, 100 times as long. Orange: left out."};
    PlotPanel scatter, arrows;
    scatter.title = "By coordinate";
    scatter.x.label = "du [px]";
    scatter.y.label = "dv [px]";
    arrows.title = "In the image";
    arrows.x.label = "x [px]";
    arrows.y.label = "height above the lowest point [px]";
    PlotCurve kept, left_out;
    kept.colour = plot_colour::k_blue;
    left_out.colour = plot_colour::k_orange;
    kept.width = left_out.width = 0;
    kept.markers = left_out.markers = true;
    PlotCurve lines;
    lines.colour = plot_colour::k_blue;
    lines.width = 1;
    const Groups groups(observations_, result_);
    double bottom = 0;
    for (std::size_t i = 0; i < groups.size(); ++i)
        bottom = std::max(bottom, observations_.place(i).at.y);
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const std::span<const double> residual = groups.of(i);
        PlotCurve& curve = result_.outliers[i] ? left_out : kept;
        curve.x.push_back(residual[0]);
        curve.y.push_back(residual[1]);
        if (result_.outliers[i]) continue;
        constexpr double k_enlarged = 100;
        const ImagePoint at = observations_.place(i).at;
        lines.x.insert(lines.x.end(), {at.x, at.x + k_enlarged * residual[0], std::nan("")});
        lines.y.insert(lines.y.end(),
                       {bottom - at.y, bottom - at.y - k_enlarged * residual[1], std::nan("")});
    }
    scatter.curves = {kept, left_out};
    arrows.curves = {lines};
    figure.panels = {scatter, arrows};
    return figure;
}

/// The observed pictures, the predicted ones, and their differences.
std::string FitReport::picture_figures() const {
    const HtmlPictures pictures;
    std::string html;
    for (std::size_t i = 0; i < observations_.images().size(); ++i) {
        const PictureResiduals::Comparison comparison = pictures_->comparison(i);
        double brightest = 0, mean = 0, count = 0;
        for (const auto& colours : comparison.seen)
            for (const double value : colours)
                if (std::isfinite(value)) {
                    brightest = std::max(brightest, value);
                    mean += value;
                    count += 1;
                }
        if (!(brightest > 0)) continue;
        mean /= count;
        html += fmt::format("<h3>{}</h3>\n", xml_escaped(observations_.images()[i]));
        const auto add = [&](const std::string& caption, const auto& shade) {
            Preview picture(comparison.width, comparison.height);
            for (int y = 0; y < comparison.height; ++y)
                for (int x = 0; x < comparison.width; ++x) {
                    const auto index =
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(comparison.width) +
                        static_cast<std::size_t>(x);
                    constexpr Srgb8 k_left_out{96, 48, 48};
                    picture(x, y) = k_left_out;
                    for (std::size_t k = 0; k < 3; ++k)
                        if (std::isfinite(comparison.seen[index][k]))
                            picture(x, y)[k] = static_cast<std::uint8_t>(std::clamp(
                                shade(comparison.seen[index][k], comparison.predicted[index][k]),
                                0.0, 255.0));
                }
            html += pictures.figure(picture, caption);
        };
        add("Seen.", [&](double seen, double) { return 255 * srgb_encode(seen / brightest); });
        add("Predicted.",
            [&](double, double predicted) { return 255 * srgb_encode(predicted / brightest); });
        add("Predicted less seen: grey where they agree, 10 % of the mean at black and white.",
            [&](double seen, double predicted) {
                constexpr double k_shown = 0.1;
                return 128 + 127 * (predicted - seen) / (k_shown * mean);
            });
    }
    return html;
}

std::string FitReport::page(const std::string& scene) const {
    const auto table = [](const std::vector<std::vector<std::string>>& rows) {
        ReportTable all{rows.front(), 1};
        for (std::size_t i = 1; i < rows.size(); ++i) all.rows.push_back({rows[i]});
        return all.html();
    };
    std::string html = fmt::format("<p>{}.</p>\n", xml_escaped(summary_line()));
    html += "<h2>What was found</h2>\n" + table(value_rows(result_));
    html += fmt::format(
        "<p>Errors are standard errors, from how the residuals spread ({:.3g} {}){}.</p>\n",
        result_.deviation, observations_.unit(),
        result_.clustering > 1
            ? fmt::format(", {:.3g} times as large as if neighbours were independent",
                          std::sqrt(result_.clustering))
            : "");
    html += "<h2>What these observations cannot tell</h2>\n";
    if (doubts_.empty()) html += "<p>Each unknown is determined by itself.</p>\n";
    for (const std::string& doubt : doubts_) html += fmt::format("<p>{}</p>\n", xml_escaped(doubt));
    html += "<h2>Residuals</h2>\n";
    html += pictures_ != nullptr ? picture_figures() : plot_html(residual_figure());
    std::vector<std::vector<std::string>> rows{{"image", fmt::format("{}s", observations_.noun()),
                                                "left out",
                                                fmt::format("RMS [{}]", observations_.unit())}};
    const std::vector<ImageSummary> images = summaries(observations_, result_);
    for (std::size_t i = 0; i < images.size(); ++i)
        rows.push_back({observations_.images()[i], std::to_string(images[i].groups),
                        std::to_string(images[i].outliers),
                        fmt::format("{:.3f}", rms_of(images[i], observations_))});
    html += table(rows);
    if (!poses_.empty()) {
        rows = {{"image", "x [m]", "y [m]", "z [m]", "± x", "± y", "± z", "± turn about x [deg]",
                 "about y", "about z"}};
        for (std::size_t i = 0; i < poses_.size(); ++i) {
            const FoundPose& pose = poses_[i];
            std::vector<std::string>& row = rows.emplace_back();
            row.push_back(observations_.images()[i]);
            for (int axis = 0; axis < 3; ++axis)
                row.push_back(
                    to_its_error(pose.world_from_camera.offset()[axis], pose.position_error[axis]));
            for (const Vector3& errors : {pose.position_error, pose.turn_error})
                for (int axis = 0; axis < 3; ++axis) row.push_back(error_text(errors[axis]));
        }
        html +=
            "<h2>Where the camera was</h2>\n<p>In the axes of each image's points, with "
            "standard errors.</p>\n" +
            table(rows);
    }
    html += fmt::format("<p>uwvdb {}</p>\n", xml_escaped(program_version()));
    return html_page("Fit of " + scene, html);
}

}  // namespace uw
