#pragma once

#include <span>

#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/scene/render_desc.h"

namespace uw {

/// The layer `clean` of a film as an image of its own, in the image's colours. Precondition: the
/// film, whose layers are `plan`, has it. Throws as make_band_colour.
Film clean_film(const Film& film, const LayerPlan& plan, const ColourDesc& colour,
                std::span<const double> bands_nm);

}  // namespace uw
