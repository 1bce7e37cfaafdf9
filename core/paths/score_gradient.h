#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/paths/contribution_gradient.h"
#include "core/paths/path_scores.h"

namespace uw {

/// The derivatives of a number by numbers of a scene, from those by the light of paths.
class ScoreGradient final : public ContributionGradient {
  public:
    /// `scenes` must outlive it. With a `seed`, of many changes a few are looked up for each term
    /// and stand for all, without bias: what a term costs has a limit.
    ScoreGradient(const ChangedScenes& scenes, std::optional<std::uint64_t> seed)
        : bands_(scenes.bands()),
          scores_(scenes),
          step_(seed ? std::max<std::size_t>(1, (scenes.changes() + k_of_term - 1) / k_of_term)
                     : 1),
          turn_(seed ? PathRandom(*seed, 0).next() : 0),
          score_(scenes.changes() * scenes.bands()),
          sums_(scenes.changes()) {}

    int add_vertex(int before, const PathVertex& vertex) override {
        if (before == k_no_vertex) scores_.begin();
        return scores_.add_vertex(before, vertex);
    }
    void add(const PathContribution& term, std::span<const double> worth) override {
        const auto steps = static_cast<double>(step_);
        const std::size_t first = std::min(static_cast<std::size_t>(turn_ * steps), step_ - 1);
        // Consecutive terms, and those of every other lamp, share the changes out evenly.
        constexpr double k_golden_ratio = 0.6180339887498949;
        turn_ += turn_ < 1 - k_golden_ratio ? k_golden_ratio : k_golden_ratio - 1;
        scores_.find(term, {first, step_}, score_);
        for (std::size_t i = first; i < sums_.size(); i += step_)
            for (std::size_t b = 0; b < bands_; ++b)
                sums_[i] += steps * worth[b] * score_[i * bands_ + b];
    }
    void finish() override {}

    /// By change of the scenes.
    std::span<const double> by_change() const { return sums_; }

  private:
    static constexpr std::size_t k_of_term = 8;

    std::size_t bands_;
    PathScores scores_;
    std::size_t step_;
    double turn_;  // whose it is, in [0, 1)
    std::vector<double> score_, sums_;
};

}  // namespace uw
