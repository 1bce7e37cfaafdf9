#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace uw {

/// By what light is weighted on its way from a lamp, or from a surface that glows, to the camera:
/// by nothing, by the length of its path in the water [m], or by that path's column of one
/// constituent [unit m]. The derivative of e^-tau is minus e^-tau, weighted: so that of an image by
/// an attenuation coefficient is minus the image of light weighted by what the coefficient
/// multiplies.
struct PathWeight {
    enum class Kind : std::uint8_t { none, length, column };

    Kind kind = Kind::none;
    std::size_t constituent = 0;  // of `column`

    explicit operator bool() const { return kind != Kind::none; }
    /// The weight of a path with this length and these columns, one per constituent.
    double of(double length, std::span<const double> columns) const {
        if (kind == Kind::none) return 1;
        return kind == Kind::length ? length : columns[constituent];
    }
};

}  // namespace uw
