#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace uw {

enum class AxisScale { linear, log };

/// A mark on an axis; a minor one has no label.
struct AxisTick {
    double value;
    std::string label;
};

/// The range of an axis and its ticks, ascending, all within the range.
struct AxisTicks {
    double min, max;
    std::vector<AxisTick> ticks;
};

/// The requested properties of an axis; those left out follow from the data.
struct AxisRequest {
    AxisScale scale = AxisScale::linear;
    std::optional<double> min, max;   // log: > 0
    std::optional<double> tick_step;  // linear: spacing of labelled ticks; else a round one
};

/// Chooses range and ticks for `values`. Those that are not finite, or not positive on a log axis,
/// are ignored; with none left the axis is 0 to 1, or 1 to 10. Unless limits are requested, the
/// range ends on round numbers: labelled ticks of a linear axis, powers of ten of a log axis. At
/// most about ten ticks are labelled; log axes have minor ticks at 2 to 9 times the powers of ten,
/// unless they span so much that these would merge.
AxisTicks choose_ticks(const AxisRequest& request, std::span<const double> values);

/// `text` as content of an XML element or attribute; bytes that are not valid UTF-8 become '?'.
std::string xml_escaped(std::string text);

/// Width of a line of UTF-8 text in a sans-serif font of size `font`, in the unit of `font`: an
/// upper estimate, as the viewer's font is not known.
double text_width(const std::string& text, double font);

/// `text` broken at spaces into lines of at most `width`, measured by text_width; all but the first
/// are indented. A longer word has a line of its own.
std::vector<std::string> wrapped_lines(const std::string& text, double width, double font);

/// Okabe and Ito's colours (2008), distinguishable with any colour vision.
namespace plot_colour {
inline constexpr const char* k_black = "#000000";
inline constexpr const char* k_orange = "#E69F00";
inline constexpr const char* k_sky = "#56B4E9";
inline constexpr const char* k_green = "#009E73";
inline constexpr const char* k_blue = "#0072B2";
inline constexpr const char* k_red = "#D55E00";
inline constexpr const char* k_purple = "#CC79A7";
}  // namespace plot_colour

/// One curve of a panel. Points that are not finite, or not positive on a log axis, break the
/// line and have no marker.
struct PlotCurve {
    std::string label;                          // in the legend; empty: not in it
    std::vector<double> x, y;                   // same length
    std::string colour = plot_colour::k_black;  // "#rrggbb"
    std::string dashes{};                       // SVG's stroke-dasharray, e.g. "6 3"; empty: solid
    double width = 1.8;                         // pixels; 0: no line
    bool markers = false;                       // a dot at each point
};

struct PlotAxis {
    std::string label;  // with its unit: "wavelength [nm]"
    AxisRequest request;
};

/// A pair of axes with curves; the legend is above them, where no curve can be.
struct PlotPanel {
    std::string title;
    PlotAxis x, y;
    std::vector<PlotCurve> curves;
};

/// Panels in rows, under one title and above a caption.
struct PlotFigure {
    std::string title;
    std::vector<std::string> caption;  // lines; long ones are wrapped
    std::vector<PlotPanel> panels;
    int columns = 2;
    double panel_width = 470, panel_height = 340;  // pixels, of title, legend, axes and labels
};

/// The figure as a self-contained SVG 1.1 document: no scripts, links or embedded fonts, a white
/// background. The same figure gives the same bytes. Invalid UTF-8 has its bad bytes replaced.
std::string svg_document(const PlotFigure& figure);

}  // namespace uw
