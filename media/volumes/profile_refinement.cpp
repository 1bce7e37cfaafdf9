#include "media/volumes/profile_refinement.h"

#include <utility>

namespace uw {
namespace {

// An interval is split if its halves are not much shorter than the least length.
constexpr double k_splittable = 1.25;

}  // namespace

void ProfileRefinement::run(const DepthTolerance& tolerance, const Sample& sample,
                            std::vector<double>& least, ConcentrationProfile& profile) {
    profile.integrate();
    open_.clear();
    for (std::size_t i = 0; i + 1 < profile.s.size(); ++i)
        open_.push_back(profile.s[i + 1] - profile.s[i] > k_splittable * least[i] ? 1 : 0);
    while (true) {
        middles_.clear();
        for (std::size_t i = 0; i < open_.size(); ++i)
            if (open_[i] != 0) middles_.push_back(0.5 * (profile.s[i] + profile.s[i + 1]));
        if (middles_.empty()) return;
        sample(middles_, values_);
        merge(tolerance, least, profile);
    }
}

// Adds the samples halfway as knots, and decides which intervals between them stay open. A sheet of
// one voxel can pass two samples as a straight line, but then it is seen from the next interval.
void ProfileRefinement::merge(const DepthTolerance& tolerance, std::vector<double>& least,
                              ConcentrationProfile& profile) {
    std::swap(profile, before_);
    std::swap(least, least_before_);
    std::swap(open_, open_before_);
    const auto count = static_cast<std::size_t>(before_.constituent_count);
    find_refused(tolerance);
    profile.constituent_count = before_.constituent_count;
    profile.s.clear();
    profile.concentration.clear();
    least.clear();
    open_.clear();
    std::size_t middle = 0;
    const auto add_knot = [&](double s, const double* concentration) {
        profile.s.push_back(s);
        profile.concentration.insert(profile.concentration.end(), concentration,
                                     concentration + count);
    };
    for (std::size_t i = 0; i < open_before_.size(); ++i) {
        add_knot(before_.s[i], &before_.concentration[i * count]);
        least.push_back(least_before_[i]);
        open_.push_back(0);
        if (open_before_[i] == 0) continue;
        const double half = middles_[middle] - before_.s[i];
        // refused_[i + 1] is the interval's own.
        const bool refused = refused_[i] != 0 || refused_[i + 1] != 0 || refused_[i + 2] != 0;
        const bool split = refused && half > k_splittable * least_before_[i];
        open_.back() = split ? 1 : 0;
        add_knot(middles_[middle], &values_[middle * count]);
        ++middle;
        least.push_back(least_before_[i]);
        open_.push_back(split ? 1 : 0);
    }
    add_knot(before_.s.back(), &before_.concentration[open_before_.size() * count]);
    profile.integrate();
}

// Finds the open intervals whose sample halfway refuses the interpolation; with one interval more
// at either end.
void ProfileRefinement::find_refused(const DepthTolerance& tolerance) {
    const auto count = static_cast<std::size_t>(before_.constituent_count);
    refused_.assign(open_before_.size() + 2, 0);
    std::size_t middle = 0;
    for (std::size_t i = 0; i < open_before_.size(); ++i) {
        if (open_before_[i] == 0) continue;
        if (!confirmed(tolerance, i, &values_[middle * count])) refused_[i + 1] = 1;
        ++middle;
    }
}

bool ProfileRefinement::confirmed(const DepthTolerance& tolerance, std::size_t interval,
                                  const double* middle) {
    const auto count = static_cast<std::size_t>(before_.constituent_count);
    const double* const begin = &before_.concentration[interval * count];
    const double length = before_.s[interval + 1] - before_.s[interval];
    error_.resize(count);
    for (std::size_t k = 0; k < count; ++k)
        error_[k] = length * (middle[k] - 0.5 * (begin[k] + begin[count + k]));
    return tolerance.allows(error_, before_.s[interval],
                            std::span(before_.column).subspan(interval * count, count));
}

}  // namespace uw
