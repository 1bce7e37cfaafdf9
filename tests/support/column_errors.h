#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/gaussian_field.h"
#include "tests/support/random_direction.h"

namespace uw::test {

/// How far columns of a map are from a cloud's own, at random points in and around it.
struct ColumnErrors {
    std::array<double, 2> largest{};  // with voxels of 0.08 and of 0.04 m
    double peak = 0;                  // the greatest column
};

/// `make_map`: the map of a field. `origin`: where the light that reaches a point comes from.
template <class MakeMap, class Origin>
ColumnErrors column_errors(const MakeMap& make_map, const Origin& origin) {
    const Point3 center{0.2, -0.1, 2.5};
    ColumnErrors errors;
    for (std::size_t level = 0; level < 2; ++level) {
        const GaussianField field(center, 0.3, 2.0, level == 0 ? 0.08 : 0.04);
        const auto map = make_map(field);
        std::mt19937 rng(3);
        std::vector<Point3> points(4000);
        for (Point3& p : points)
            p = center + std::uniform_real_distribution<double>(0, 2)(rng) * random_direction(rng);
        std::vector<double> columns(points.size());
        map.columns(points, columns);
        for (std::size_t i = 0; i < points.size(); ++i) {
            double truth = 0;
            field.column(origin(points[i]), points[i], std::span<double>(&truth, 1));
            errors.largest[level] = std::max(errors.largest[level], std::abs(columns[i] - truth));
            errors.peak = std::max(errors.peak, truth);
        }
    }
    return errors;
}

}  // namespace uw::test
