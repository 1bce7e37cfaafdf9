#pragma once

#include <vector>

#include "render/validation/port_photographs.h"
#include "render/validation/published_figure.h"

namespace uw {

struct PublishedComparison {
    std::vector<PublishedFigure> figures;
    std::vector<PortPhotographs> photographs;

    bool passed() const;
};

/// Computes published results: the corners of boards in photographs by real cameras behind ports,
/// the canonical problems of ocean optics, the scattering of measured waters, and a lamp in water
/// rendered by Blender's Cycles. Throws Interrupted.
PublishedComparison compare_with_published(const PublishedOptions& options);

}  // namespace uw
