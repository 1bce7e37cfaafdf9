#pragma once

#include "core/light/medium.h"

namespace uw::test {

/// A tolerance in units of a single constituent's column: one band, no water, 1 1/m per unit.
inline DepthTolerance column_tolerance(double tolerance) {
    Medium medium;
    medium.wavelengths_nm = {550};
    Constituent constituent{"density", "1", {}};
    constituent.per_unit.absorption[0] = 1;
    medium.constituents = {constituent};
    return {medium, tolerance};
}

}  // namespace uw::test
