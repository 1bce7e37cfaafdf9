#include "cli/sweep/sweep_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cli/numbers/number_columns.h"
#include "core/tables/csv_cells.h"

namespace uw {

namespace {

/// Something measured at a point, by which a curve is drawn.
struct Quantity {
    std::string label;
    std::function<double(const SweepPoint&)> value;  // NaN: there is none
};

enum class Kind { contrast, ratio, evenness };

double number_of_part(const SweepPoint& point, const std::string& part, Kind kind) {
    const auto found = std::ranges::find(point.parts, part, &PartNumbers::part);
    if (found == point.parts.end()) return std::numeric_limits<double>::quiet_NaN();
    const PictureNumbers& numbers = found->numbers.picture;
    if (kind == Kind::contrast) return numbers.contrast;
    if (kind == Kind::ratio) return numbers.signal_to_backscatter;
    if (!numbers.evenness || numbers.evenness->pixels == 0)
        return std::numeric_limits<double>::quiet_NaN();
    return numbers.evenness->percentile5_to_mean;
}

/// The names of all parts that were measured, in their order.
std::vector<std::string> parts_of(const Sweep& sweep) {
    std::vector<std::string> names;
    for (const SweepPoint& point : sweep.points)
        for (const PartNumbers& part : point.parts)
            if (std::ranges::find(names, part.part) == names.end()) names.push_back(part.part);
    return names;
}

std::vector<Quantity> quantities_of(const Sweep& sweep, Kind kind) {
    std::vector<Quantity> quantities;
    for (const std::string& part : parts_of(sweep))
        quantities.push_back(
            {part, [part, kind](const SweepPoint& p) { return number_of_part(p, part, kind); }});
    if (kind == Kind::evenness || sweep.points.empty() || !sweep.points.front().target)
        return quantities;
    quantities.push_back({fmt::format("target at {:g} m", sweep.points.front().target->distance),
                          [kind](const SweepPoint& p) {
                              return kind == Kind::contrast ? p.target->contrast
                                                            : p.target->signal_to_backscatter;
                          }});
    return quantities;
}

PlotCurve styled(std::string label, std::size_t index) {
    static constexpr std::array k_colours{
        plot_colour::k_blue,   plot_colour::k_red, plot_colour::k_green, plot_colour::k_orange,
        plot_colour::k_purple, plot_colour::k_sky, plot_colour::k_black};
    static constexpr std::array k_dashes{"", "8 3", "2 2.5", "9 3 2 3"};
    PlotCurve curve{std::move(label), {}, {}, k_colours[index % k_colours.size()]};
    curve.dashes = k_dashes[index / k_colours.size() % k_dashes.size()];
    curve.markers = true;
    return curve;
}

/// Logarithmic where curves lie so far apart that some would be flat.
AxisScale scale_for(const std::vector<PlotCurve>& curves) {
    double least = std::numeric_limits<double>::infinity(), greatest = 0;
    for (const PlotCurve& curve : curves)
        for (const double value : curve.y)
            if (std::isfinite(value) && value > 0) {
                least = std::min(least, value);
                greatest = std::max(greatest, value);
            }
    constexpr double k_far_apart = 20;
    return greatest > k_far_apart * least ? AxisScale::log : AxisScale::linear;
}

PlotPanel panel_of(const Sweep& sweep, const SweepArguments& a, Kind kind, const char* title,
                   const char* label) {
    PlotPanel panel{title, {sweep.keys.front(), {}}, {label, {}}, {}};
    if (kind != Kind::ratio) panel.y.request.min = 0;
    if (kind == Kind::evenness) panel.y.request.max = 1;
    std::vector<Quantity> quantities = quantities_of(sweep, kind);
    if (quantities.empty()) return panel;
    const std::size_t curves = a.axes.size() > 1 ? a.axes[1].values.size() : quantities.size();
    for (std::size_t i = 0; i < curves; ++i) {
        const bool by_value = a.axes.size() > 1;
        const Quantity& quantity = by_value ? quantities.back() : quantities[i];
        PlotCurve curve =
            styled(by_value ? fmt::format("{:g}", a.axes[1].values[i]) : quantity.label, i);
        for (const SweepPoint& point : sweep.points) {
            if (by_value && point.values[1] != a.axes[1].values[i]) continue;
            curve.x.push_back(point.values[0]);
            curve.y.push_back(quantity.value(point));
        }
        if (!curve.x.empty()) panel.curves.push_back(std::move(curve));
    }
    if (kind == Kind::ratio) panel.y.request.scale = scale_for(panel.curves);
    if (a.axes.size() > 1) panel.title += fmt::format(" ({})", quantities.back().label);
    return panel;
}

}  // namespace

std::string sweep_csv(const Sweep& sweep) {
    const bool has_target = !sweep.points.empty() && sweep.points.front().target;
    std::string text;
    for (const std::string& key : sweep.keys) text += csv_text(key) + ",";
    text += "part" + number_names_csv();
    if (has_target)
        text +=
            ",target_distance,target_contrast,target_signal,target_backscatter,"
            "target_signal_to_backscatter,target_irradiance";
    text += "\n";
    for (const SweepPoint& point : sweep.points)
        for (const PartNumbers& part : point.parts) {
            for (const double value : point.values) text += fmt::format("{},", value);
            text += csv_text(part.part) + number_values_csv(part.numbers);
            if (const auto& t = point.target)
                for (const double value : {t->distance, t->contrast, t->signal, t->backscatter,
                                           t->signal_to_backscatter, t->irradiance})
                    text += "," + number_cell(value);
            text += "\n";
        }
    return text;
}

PlotFigure sweep_figure(const Sweep& sweep, const SweepArguments& a) {
    PlotFigure figure;
    figure.title = a.scene.filename().string() + " over " + sweep.keys.front();
    for (std::size_t i = 1; i < a.axes.size(); ++i)
        figure.title += ", for values of " + a.axes[i].key;
    figure.panels = {
        panel_of(sweep, a, Kind::contrast, "Contrast", "Michelson contrast"),
        panel_of(sweep, a, Kind::ratio, "Signal to backscatter", "signal / backscatter"),
        panel_of(sweep, a, Kind::evenness, "Evenness of irradiance", "percentile 5 / mean")};
    figure.columns = 3;
    figure.panel_width = 400;
    std::string along;
    for (const SweepAxis& axis : a.companions)
        along += fmt::format("{}{} from {:g} to {:g}", along.empty() ? "Along with it: " : ", ",
                             axis.key, axis.values.front(), axis.values.back());
    if (!along.empty()) figure.caption.push_back(along + ".");
    figure.caption.push_back(
        fmt::format("Pictures of {} x {} pixels{}. Definitions: docs/edit-numbers.md.", sweep.width,
                    sweep.height, sweep.is_complete ? "" : "; interrupted, not all of them"));
    return figure;
}

std::string best_of(const Sweep& sweep) {
    const std::vector<Quantity> quantities = quantities_of(sweep, Kind::contrast);
    if (quantities.empty()) return {};
    const Quantity& quantity = quantities.back();
    const SweepPoint* best = nullptr;
    for (const SweepPoint& point : sweep.points)
        if (!std::isnan(quantity.value(point)) &&
            (best == nullptr || quantity.value(point) > quantity.value(*best)))
            best = &point;
    if (best == nullptr) return {};
    std::string text =
        fmt::format("best contrast of {}: {:.3g} at", quantity.label, quantity.value(*best));
    for (std::size_t i = 0; i < sweep.keys.size(); ++i)
        text += fmt::format(" {}={:g}", sweep.keys[i], best->values[i]);
    return text;
}

}  // namespace uw
