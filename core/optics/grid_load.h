#pragma once

namespace uw {

/// The concentration that one unit of a grid's value adds to a constituent of the water.
struct GridLoad {
    int constituent = 0;
    double per_unit = 0;  // in the constituent's unit, e.g. ppm

    friend bool operator==(const GridLoad&, const GridLoad&) = default;
};

}  // namespace uw
