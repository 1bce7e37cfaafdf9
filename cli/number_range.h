#pragma once

#include <optional>
#include <string_view>

namespace uw {

/// FIRST:LAST:STEP, the numbers from `first` to `last` by `step`, as options take them.
struct NumberRange {
    double first = 0, last = 0, step = 1;

    /// How many numbers it has, whichever way the step points. `last` is one of them, even if its
    /// distance is a multiple of the step up to rounding only. Precondition: the step is not 0.
    double count() const;
    /// Its number `i`, counted from 0; the step points from `first` to `last`.
    double at(int i) const;
};

/// The range that `text` describes; none if it is something else than three numbers.
std::optional<NumberRange> number_range_in(std::string_view text);

}  // namespace uw
