#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/validate/validation_methods.h"

namespace uw {

/// One sum over slabs, compared with the limit of many.
struct PlanesStep {
    int count = 0;
    double error = 0;  // largest relative difference to the limit over smooth pixels and bands
    double order = 0;  // log2 of how much smaller it is than with half the slabs; 0 for the first
};

/// McGlamery's sums of backscatter over ever more slabs of uniform water.
struct PlaneSums {
    MethodImage limit;            // of infinitely many slabs
    MethodImage finest, coarser;  // the sum over the most slabs, and that over half as many
    std::vector<PlanesStep> steps;
};

struct PlaneSumOptions {
    double tolerance;  // sums are refined while they change by more [relative]
    int most_planes;   // slabs of the finest sum, and more where it is still rough
    std::function<bool()> proceed;
    std::function<void(const std::string&)> say;  // gets the name of each sum
};

/// Doubles the number of slabs until the largest change over the pixels that `smooth` marks is
/// within the tolerance, and at least up to `most_planes`; beyond that not for more than some 20
/// seconds. The midpoint rule's error falls with the square of the thickness, so the limit is
/// (4 fine - coarse) / 3 (Richardson); where a shadow's edge crosses the ray it falls with the
/// thickness only, and the limit may be off by as much as the last two sums differ.
PlaneSums sum_planes_to_limit(const TrialScene& uniform, const std::vector<char>& smooth,
                              const PlaneSumOptions& options);

/// The name of the sum over `count` slabs.
std::string planes_name(int count);

}  // namespace uw
