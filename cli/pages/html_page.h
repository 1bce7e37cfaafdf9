#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/pages/svg_plot.h"
#include "core/base/output_files.h"
#include "core/image/pixel_image.h"

namespace uw {

/// The outcome of a check.
enum class Verdict : std::uint8_t { none, passed, failed, not_compared };

/// "passed" or "FAILED", in colour.
std::string verdict_html(bool passed);

/// A table for people, as lines of text or in HTML. All rows have as many cells as there are
/// headings; a verdict follows after them.
struct ReportTable {
    struct Row {
        std::vector<std::string> cells;
        Verdict verdict = Verdict::none;
    };
    std::vector<std::string> headings;
    std::size_t names;  // number of leading columns that contain no numbers
    std::vector<Row> rows{};

    /// Indented lines. Rows of failed checks are red if `colour` is set.
    std::string text(bool colour) const;
    /// A table element; the cells are text, and are escaped.
    std::string html() const;
};

/// Turns pictures into HTML that needs no other files; owns the folder for temporary ones.
class HtmlPictures {
  public:
    /// A figure element: a picture with a caption below. Throws IoError.
    std::string figure(const Preview& picture, const std::string& caption) const;

  private:
    ScratchFolder folder_;
};

/// A plot as an image of its own, so that nothing in it has the same name as in another.
std::string plot_html(const PlotFigure& plot);

/// One self-contained page with this title, which is its first heading, too. `body` is HTML. The
/// same arguments give the same bytes.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace uw
