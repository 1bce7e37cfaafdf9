#pragma once

#include <vector>

#include "render/validation/published_figure.h"

namespace uw {

/// Appends what light meters read in the canonical problems of ocean optics (Mobley et al. 1993):
/// 1, 2, 3, 5 and 6, or that which options.only names. Throws Interrupted.
void append_canonical_problems(const PublishedOptions& options,
                               std::vector<PublishedFigure>& figures);

/// Appends the rate at which irradiance falls far down in problem 2, "asymptotic K".
void append_asymptotic(const PublishedOptions& options, std::vector<PublishedFigure>& figures);

}  // namespace uw
