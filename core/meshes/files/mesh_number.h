#pragma once

#include <limits>
#include <optional>
#include <string_view>

#include "core/base/text.h"

namespace uw {

/// A coordinate as text formats write it: NaN if it is not finite or too large, so that what has it
/// is dropped and counted; 0 if it is too small. None if `word` is no number.
inline std::optional<float> mesh_number(std::string_view word) {
    double value = 0;
    switch (parse_number(word, value)) {
        case NumberText::number:
            return static_cast<float>(value);
        case NumberText::not_finite:
            return std::numeric_limits<float>::quiet_NaN();
        case NumberText::out_of_range:
            return word.find("e-") != std::string_view::npos ||
                           word.find("E-") != std::string_view::npos
                       ? 0.0F
                       : std::numeric_limits<float>::quiet_NaN();
        case NumberText::no_number:
            break;
    }
    return std::nullopt;
}

}  // namespace uw
