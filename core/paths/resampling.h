#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace uw {

/// A candidate of resampled importance sampling (Talbot, Cline and Egbert 2005): one of several is
/// taken in proportion to response * radiance / density.
struct ResamplingCandidate {
    double radiance = 0;  // expected to go on along the path
    double response = 0;  // of the water or the surface, summed over the bands with the throughput
    double density = 0;   // with which any candidate is sampled there, times their number

    double weight() const { return response * radiance / density; }
};

/// Raises the radiance of each candidate to at least `min_relative` of their mean: light that
/// shines after all where none was expected would be too bright. Returns the sum of their weights.
template <class Candidate>
double sum_of_weights(std::vector<Candidate>& candidates, double min_relative) {
    double sum = 0, sum_of_responses = 0;
    for (const Candidate& candidate : candidates) {
        sum += candidate.weight();
        sum_of_responses += candidate.response / candidate.density;
    }
    if (!(sum > 0)) return 0;
    const double min_radiance = min_relative * sum / sum_of_responses;
    sum = 0;
    for (Candidate& candidate : candidates) {
        candidate.radiance = std::max(candidate.radiance, min_radiance);
        sum += candidate.weight();
    }
    return sum;
}

/// The candidate at which the running sum of the weights exceeds `target`. Precondition: there is
/// one.
template <class Candidate>
const Candidate& choose_candidate(const std::vector<Candidate>& candidates, double target) {
    std::size_t i = 0;
    while (i + 1 < candidates.size() && target >= candidates[i].weight())
        target -= candidates[i++].weight();
    return candidates[i];
}

}  // namespace uw
