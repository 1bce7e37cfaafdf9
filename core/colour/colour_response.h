#pragma once

#include <span>

#include "core/colour/colour.h"
#include "core/scene/render_desc.h"

namespace uw {

/// The conversion from bands to R G B that the scene specifies: directly, by CIE 1931, or by a
/// camera's response curves, a table of wavelength_nm,r,g,b up to a factor, whose values are
/// responses to power. A camera's R, G and B stay in its own colour space: each is the mean
/// response over the bands' intervals, scaled such that equal values in all bands have G = 1 and
/// the white light has R = G = B. Throws InputError for an invalid table, for a channel without
/// response in any band, and for a white light that a channel does not see; IoError for a file that
/// cannot be read.
BandColour make_band_colour(const ColourDesc& desc, std::span<const double> bands_nm);

}  // namespace uw
