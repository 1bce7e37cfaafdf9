#pragma once

#include <span>

#include "core/colour/colour.h"
#include "core/scene/render_desc.h"

namespace uw {

/// How the scene wants its bands shown as R G B: as they are, by CIE 1931, or by the response
/// curves of a camera, a table of wavelength_nm,r,g,b up to a factor, whose values count as the
/// response to power. A camera's R, G and B stay in its own colour space: each is the mean response
/// over the bands' intervals, scaled so that equal values in all bands have G = 1 and the light
/// that is white has R = G = B. Throws InputError for a table that is none, for a channel that sees
/// nothing of the bands, and for a white light of which that is so; IoError for a file that cannot
/// be read.
BandColour make_band_colour(const ColourDesc& desc, std::span<const double> bands_nm);

}  // namespace uw
