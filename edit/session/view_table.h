#pragma once

#include <string>

#include "core/image/colour_view.h"

namespace uw {

/// A view of light as the page applies it: a table of display values over R, G and B, each at equal
/// steps of log2(1 + value/k_least), from 0 to the brightest. Between them the page interpolates
/// linearly. It is brighter than any display: what is beyond is the last step.
struct ViewTable {
    static constexpr int k_side = 48;             // steps per channel
    static constexpr double k_least = 1.0 / 512;  // where equal steps of light become equal ratios
    static constexpr int k_octaves = 16;          // log2(1 + brightest/k_least)

    /// The bytes R, G and B (0 to 255) of each combination, red first, blue last. Negative light
    /// counts as none.
    static std::string bytes_of(const ColourView& view);
};

}  // namespace uw
