#include "cli/pages/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/base/text.h"

namespace uw {

namespace {

constexpr double k_linear_intervals = 7;  // at most, between labelled ticks
constexpr int k_log_labels = 8;           // at most, at powers of ten
constexpr int k_minor_decades = 12;       // with more, minor ticks would merge
// Axes extend no further: room for every meaningful double without overflow.
constexpr double k_largest = 1e200;

/// 10^n as "10⁻³"; superscripts are characters, as SVG programs differ on baseline-shift.
std::string power_of_ten(int exponent) {
    static constexpr const char* k_digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = exponent < 0 ? "10⁻" : "10";
    for (const char digit : fmt::format("{}", std::abs(exponent))) text += k_digits[digit - '0'];
    return text;
}

/// The multiple of 1, 2 or 5 times a power of ten that is not less than `x` > 0.
double round_step(double x) {
    const double power = std::pow(10, std::floor(std::log10(x)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= x * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

std::string linear_label(double value, double step) {
    if (std::abs(value) < 1e-9 * step) return "0";
    if (std::abs(value) >= 1e5 || step < 1e-4) return fmt::format("{:.6g}", value);
    int decimals = 0;
    for (double scaled = step; decimals < 6; ++decimals, scaled *= 10)
        if (std::abs(scaled - std::round(scaled)) < 1e-6 * scaled) break;
    return fmt::format("{:.{}f}", value, decimals);
}

AxisTicks linear_ticks(const AxisRequest& request, double low, double high) {
    AxisTicks axis{request.min.value_or(low), request.max.value_or(high), {}};
    if (!(axis.max > axis.min)) {
        const double pad = std::max(1e-12, 0.5 * std::abs(axis.min));
        if (!request.min) axis.min -= pad;
        axis.max = axis.min + 2 * pad;
    }
    const double length = axis.max - axis.min;
    double step = round_step(length / k_linear_intervals);
    if (request.tick_step && length / *request.tick_step < 100) step = *request.tick_step;
    if (!request.min) axis.min = step * std::floor(axis.min / step + 1e-9);
    if (!request.max) axis.max = step * std::ceil(axis.max / step - 1e-9);
    const double first = std::ceil(axis.min / step - 1e-9);
    const double last = std::floor(axis.max / step + 1e-9);
    for (double i = first; i <= last; ++i)
        axis.ticks.push_back(
            {std::clamp(i * step, axis.min, axis.max), linear_label(i * step, step)});
    return axis;
}

AxisTicks log_ticks(const AxisRequest& request, double low, double high) {
    AxisTicks axis{request.min.value_or(low), request.max.value_or(high), {}};
    if (!(axis.max >= axis.min)) axis.max = axis.min;
    if (!request.min) axis.min = std::pow(10, std::floor(std::log10(axis.min) + 1e-9));
    if (!request.max) axis.max = std::pow(10, std::ceil(std::log10(axis.max) - 1e-9));
    if (!(axis.max > axis.min)) axis.max = 10 * axis.min;
    const int first = static_cast<int>(std::floor(std::log10(axis.min) + 1e-9));
    const int last = static_cast<int>(std::ceil(std::log10(axis.max) - 1e-9));
    const int decades = last - first;
    const int labelled = (decades + k_log_labels - 1) / k_log_labels;  // decades per label
    const bool plain = first >= -2 && last <= 3;
    const bool short_axis = decades <= 2;  // then powers of ten alone are too few labels
    const auto inside = [&](double value) {
        return value >= axis.min * (1 - 1e-9) && value <= axis.max * (1 + 1e-9);
    };
    for (int n = first; n <= last; ++n)
        for (int factor = 1; factor <= 9; ++factor) {
            const double value = factor * std::pow(10, n);
            if (!inside(value) || (factor > 1 && decades > k_minor_decades)) continue;
            std::string label;
            if (factor == 1 && (n - first) % labelled == 0)
                label = plain ? fmt::format("{:g}", value) : power_of_ten(n);
            else if (short_axis && (factor == 2 || factor == 5))
                label = plain ? fmt::format("{:g}", value)
                              : fmt::format("{}·{}", factor, power_of_ten(n));
            axis.ticks.push_back({std::clamp(value, axis.min, axis.max), label});
        }
    return axis;
}

}  // namespace

AxisTicks choose_ticks(const AxisRequest& request, std::span<const double> values) {
    const bool log = request.scale == AxisScale::log;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : values) {
        if (!(std::abs(value) < k_largest) || (log && !(value > 1 / k_largest))) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    if (!(low <= high)) {
        low = log ? 1 : 0;
        high = log ? 10 : 1;
    }
    return log ? log_ticks(request, low, high) : linear_ticks(request, low, high);
}

namespace {

constexpr double k_glyph_width = 0.6;  // of the font's size

std::size_t glyph_count(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
        return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
    }));
}

}  // namespace

double text_width(const std::string& text, double font) {
    return k_glyph_width * font * static_cast<double>(glyph_count(text));
}

std::string xml_escaped(std::string text) {
    for (std::size_t bad = first_non_text(text); bad < text.size(); bad = first_non_text(text))
        text[bad] = '?';
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::vector<std::string> wrapped_lines(const std::string& text, double width, double font) {
    std::vector<std::string> lines{""};
    std::size_t start = 0;
    while (start < text.size()) {
        const std::size_t end = std::min(text.find(' ', start), text.size());
        const std::string word = text.substr(start, end - start);
        if (!lines.back().empty() && text_width(lines.back() + " " + word, font) > width)
            lines.emplace_back("  " + word);
        else
            lines.back() += (lines.back().empty() ? "" : " ") + word;
        start = end + 1;
    }
    return lines;
}

namespace {

constexpr double k_font = 13, k_title_font = 17, k_line = 18;
constexpr double k_left = 76, k_right = 18, k_bottom = 50, k_margin = 14;
constexpr std::size_t k_many_dots = 12;  // on one curve: above this, smaller dots that do not merge
constexpr double k_swatch = 30, k_legend_gap = 16;

struct Box {
    double left, top, right, bottom;
};

/// Where a value lies on an axis, 0 to 1 within its range.
double position_on(const AxisTicks& axis, AxisScale scale, double value) {
    if (scale == AxisScale::linear) return (value - axis.min) / (axis.max - axis.min);
    return std::log(value / axis.min) / std::log(axis.max / axis.min);
}

class Writer {
  public:
    explicit Writer(const PlotFigure& figure) : figure_(figure) {}
    std::string document();

  private:
    template <class... Args>
    void put(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(out_), format, std::forward<Args>(args)...);
    }
    void text(double x, double y, const char* anchor, const std::string& content,
              const char* extra = "");
    void panel(const PlotPanel& panel, double x, double y);
    void legend(const PlotPanel& panel, double x, double y);
    void axes(const PlotPanel& panel, const AxisTicks& x, const AxisTicks& y, const Box& box);
    void curve(const PlotPanel& panel, const PlotCurve& curve, const AxisTicks& x,
               const AxisTicks& y, const Box& box);
    void swatch(const PlotCurve& curve, double x, double y);
    template <class Place>
    void place_legend(const PlotPanel& panel, Place place) const;
    int legend_rows(const PlotPanel& panel) const;

    const PlotFigure& figure_;
    std::string out_;
    int clip_ = 0;
};

void Writer::text(double x, double y, const char* anchor, const std::string& content,
                  const char* extra) {
    put("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, extra,
        xml_escaped(content));
}

template <class Place>
void Writer::place_legend(const PlotPanel& panel, Place place) const {
    const double width = figure_.panel_width - k_left - k_right;
    double x = 0;
    int row = 0;
    for (const PlotCurve& curve : panel.curves) {
        if (curve.label.empty()) continue;
        const double entry = k_swatch + 6 + text_width(curve.label, k_font);
        if (x > 0 && x + entry > width) {
            x = 0;
            ++row;
        }
        place(curve, x, row);
        x += entry + k_legend_gap;
    }
}

int Writer::legend_rows(const PlotPanel& panel) const {
    int rows = 0;
    place_legend(panel, [&](const PlotCurve&, double, int row) { rows = row + 1; });
    return rows;
}

std::string stroke(const PlotCurve& curve) {
    std::string text =
        fmt::format("stroke=\"{}\" stroke-width=\"{:g}\"", xml_escaped(curve.colour), curve.width);
    if (!curve.dashes.empty())
        text += fmt::format(" stroke-dasharray=\"{}\"", xml_escaped(curve.dashes));
    return text;
}

void Writer::swatch(const PlotCurve& curve, double x, double y) {
    if (curve.width > 0)
        put("<path d=\"M{:.1f} {:.1f}h{:g}\" fill=\"none\" {}/>\n", x, y, k_swatch, stroke(curve));
    if (curve.markers)
        put("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", x + k_swatch / 2, y,
            xml_escaped(curve.colour));
}

void Writer::legend(const PlotPanel& panel, double x, double y) {
    place_legend(panel, [&](const PlotCurve& curve, double at, int row) {
        const double line = y + k_line * row;
        swatch(curve, x + at, line - 4.5);
        text(x + at + k_swatch + 6, line, "start", curve.label);
    });
}

void Writer::axes(const PlotPanel& panel, const AxisTicks& x, const AxisTicks& y, const Box& box) {
    for (const AxisTick& tick : x.ticks) {
        const double at =
            box.left + position_on(x, panel.x.request.scale, tick.value) * (box.right - box.left);
        const bool major = !tick.label.empty();
        if (major)
            put("<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", at, box.top, box.bottom);
        put("<path class=\"tick\" d=\"M{:.1f} {:.1f}v{}\"/>\n", at, box.bottom, major ? -7 : -4);
        if (major) text(at, box.bottom + 17, "middle", tick.label);
    }
    for (const AxisTick& tick : y.ticks) {
        const double at =
            box.bottom - position_on(y, panel.y.request.scale, tick.value) * (box.bottom - box.top);
        const bool major = !tick.label.empty();
        if (major)
            put("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", box.left, at, box.right);
        put("<path class=\"tick\" d=\"M{:.1f} {:.1f}h{}\"/>\n", box.left, at, major ? 7 : 4);
        if (major) text(box.left - 7, at + 4.5, "end", tick.label);
    }
    put("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
        box.left, box.top, box.right - box.left, box.bottom - box.top);
    text((box.left + box.right) / 2, box.bottom + 38, "middle", panel.x.label);
    const double middle = (box.top + box.bottom) / 2, side = box.left - k_left + 16;
    text(side, middle, "middle", panel.y.label,
         fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", side, middle).c_str());
}

void Writer::curve(const PlotPanel& panel, const PlotCurve& curve, const AxisTicks& x,
                   const AxisTicks& y, const Box& box) {
    const auto shown = [](const PlotAxis& axis, double value) {
        return std::isfinite(value) && (axis.request.scale == AxisScale::linear || value > 0);
    };
    const double radius = curve.x.size() > k_many_dots ? 2 : 3.5;
    // Far outside the frame a point only sets the direction of its line; limit its coordinates.
    const auto place = [](double from, double to, double t) {
        return from + std::clamp(t, -50.0, 50.0) * (to - from);
    };
    std::string path, dots;
    bool pen_down = false;
    for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
        const bool visible = shown(panel.x, curve.x[i]) && shown(panel.y, curve.y[i]);
        if (visible) {
            const double tx = position_on(x, panel.x.request.scale, curve.x[i]);
            const double ty = position_on(y, panel.y.request.scale, curve.y[i]);
            const double px = place(box.left, box.right, tx);
            const double py = place(box.bottom, box.top, ty);
            path += fmt::format("{}{:.2f} {:.2f}", pen_down ? "L" : "M", px, py);
            const bool inside = tx > -1e-9 && tx < 1 + 1e-9 && ty > -1e-9 && ty < 1 + 1e-9;
            if (curve.markers && inside)
                dots +=
                    fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\"/>", px, py, radius);
        }
        pen_down = visible;
    }
    if (curve.width > 0 && !path.empty())
        put("<path class=\"curve\" d=\"{}\" clip-path=\"url(#clip{})\" {}/>\n", path, clip_,
            stroke(curve));
    if (!dots.empty()) put("<g fill=\"{}\">{}</g>\n", xml_escaped(curve.colour), dots);
}

void Writer::panel(const PlotPanel& panel, double x, double y) {
    std::vector<double> xs, ys;
    int rows = 0;
    const AxisRequest& x_range = panel.x.request;
    for (const PlotCurve& curve : panel.curves) {
        xs.insert(xs.end(), curve.x.begin(), curve.x.end());
        for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i)
            if (curve.x[i] >= x_range.min.value_or(curve.x[i]) &&
                curve.x[i] <= x_range.max.value_or(curve.x[i]))
                ys.push_back(curve.y[i]);
    }
    // All legends of a row are as high as its highest, so that its axes align.
    for (const PlotPanel& other : figure_.panels) rows = std::max(rows, legend_rows(other));
    const double head = k_line * (rows + 1) + 10;
    const Box box{x + k_left, y + head, x + figure_.panel_width - k_right,
                  y + figure_.panel_height - k_bottom};
    const AxisTicks x_ticks = choose_ticks(panel.x.request, xs);
    const AxisTicks y_ticks = choose_ticks(panel.y.request, ys);
    put("<g>\n");
    text(box.left, y + k_line - 4, "start", panel.title, " font-weight=\"bold\"");
    legend(panel, box.left, y + 2 * k_line);
    // Slightly more than the frame, so that a curve along it keeps its width.
    constexpr double k_slack = 2;
    put("<clipPath id=\"clip{}\"><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
        "height=\"{:.1f}\"/></clipPath>\n",
        ++clip_, box.left - k_slack, box.top - k_slack, box.right - box.left + 2 * k_slack,
        box.bottom - box.top + 2 * k_slack);
    axes(panel, x_ticks, y_ticks, box);
    for (const PlotCurve& c : panel.curves) curve(panel, c, x_ticks, y_ticks, box);
    put("</g>\n");
}

std::string Writer::document() {
    const int columns =
        std::max(1, std::min(figure_.columns, static_cast<int>(figure_.panels.size())));
    const int rows = (static_cast<int>(figure_.panels.size()) + columns - 1) / columns;
    const double width = 2 * k_margin + columns * figure_.panel_width;
    const std::vector<std::string> title =
        wrapped_lines(figure_.title, width - 2 * k_margin, k_title_font);
    const double title_line = 1.4 * k_title_font;
    const double head =
        figure_.title.empty() ? 0 : title_line * static_cast<double>(title.size()) + 8;
    std::vector<std::string> caption;
    for (const std::string& line : figure_.caption)
        for (std::string& part : wrapped_lines(line, width - 4 * k_margin, k_font))
            caption.push_back(std::move(part));
    const double panels_end = k_margin + head + rows * figure_.panel_height;
    const double height = panels_end + k_line * static_cast<double>(caption.size()) + k_margin;

    put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" role=\"img\" "
        "font-family=\"DejaVu Sans, Verdana, Helvetica, Arial, sans-serif\" font-size=\"{2:g}\">\n"
        "<title>{3}</title>\n"
        "<style>.grid{{stroke:#ddd;fill:none}}.tick{{stroke:#333;fill:none}}"
        ".frame{{stroke:#333;fill:none}}.curve{{fill:none;stroke-linejoin:round}}</style>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        width, height, k_font, xml_escaped(figure_.title));
    for (std::size_t i = 0; i < title.size(); ++i)
        text(k_margin, k_margin + k_title_font + title_line * static_cast<double>(i), "start",
             title[i],
             fmt::format(" font-size=\"{:g}\" font-weight=\"bold\"", k_title_font).c_str());
    for (std::size_t i = 0; i < figure_.panels.size(); ++i) {
        const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
        panel(figure_.panels[i], k_margin + column * figure_.panel_width,
              k_margin + head + row * figure_.panel_height);
    }
    for (std::size_t i = 0; i < caption.size(); ++i)
        text(2 * k_margin, panels_end + k_line * (static_cast<double>(i) + 0.7), "start",
             caption[i]);
    put("</svg>\n");
    return std::move(out_);
}

}  // namespace

std::string svg_document(const PlotFigure& figure) {
    return Writer(figure).document();
}

}  // namespace uw
