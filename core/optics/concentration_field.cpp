#include "core/optics/concentration_field.h"

namespace uw {

void ConcentrationProfile::integrate() {
    const auto count = static_cast<std::size_t>(constituent_count);
    column.assign(concentration.size(), 0.0);
    for (std::size_t knot = 1; knot < s.size(); ++knot) {
        const double half = 0.5 * (s[knot] - s[knot - 1]);
        for (std::size_t i = knot * count; i < (knot + 1) * count; ++i) {
            const double sum = concentration[i] + concentration[i - count];
            column[i] = column[i - count];
            // Avoids 0 * infinity on an unbounded ray.
            if (sum != 0) column[i] += half * sum;
        }
    }
}

}  // namespace uw
