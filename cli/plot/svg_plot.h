#pragma once

#include <string>
#include <vector>

#include "cli/plot/plot_ticks.h"

namespace uw {

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
