#pragma once

#include <vector>

#include "validation/port_photographs.h"
#include "validation/published_figure.h"

namespace uw {

struct PublishedComparison {
    std::vector<PublishedFigure> figures;
    std::vector<PortPhotographs> photographs;

    bool passed() const;
};

/// Computes what others have published: where real cameras behind ports have seen corners of
/// boards, the canonical problems of ocean optics, the scattering of measured waters, and what
/// Blender's Cycles makes of a lamp in water. Throws Interrupted.
PublishedComparison compare_with_published(const PublishedOptions& options);

}  // namespace uw
