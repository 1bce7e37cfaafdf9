#pragma once

#include <limits>
#include <optional>
#include <string_view>

#include "core/base/text.h"

namespace uw {

/// A coordinate as text formats write it: NaN if it is not finite; none if `word` is no number.
inline std::optional<float> mesh_number(std::string_view word) {
    double value = 0;
    switch (parse_number(word, value)) {
        case NumberText::number:
            return static_cast<float>(value);
        case NumberText::not_finite:
            return std::numeric_limits<float>::quiet_NaN();
        case NumberText::out_of_range:
            return 0.0F;  // too small, or so large that nothing is lost with it
        case NumberText::no_number:
            break;
    }
    return std::nullopt;
}

}  // namespace uw
