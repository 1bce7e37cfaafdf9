#pragma once

#include <string>

#include "render/validation/published.h"

namespace uw {

/// All figures as lines of text; what failed is red if `colour` is set.
std::string published_text(const PublishedComparison& comparison, bool colour);

/// One self-contained HTML page to cite: how the figures were found, published and ours, with
/// errors and tolerances, plots, sources and version. No dates: the same program gives the same
/// bytes.
std::string published_page(const PublishedComparison& comparison);

}  // namespace uw
