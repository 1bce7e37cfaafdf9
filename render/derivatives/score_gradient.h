#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "render/derivatives/contribution_gradient.h"
#include "render/derivatives/path_scores.h"

namespace uw {

/// The derivatives of a scalar by parameters of a scene, given its derivatives by the contributions
/// of light paths.
class ScoreGradient final : public ContributionGradient {
  public:
    /// `scenes` must outlive this object. With a `seed`, each contribution evaluates only a few of
    /// many changes, which represent all of them without bias, so that its cost is bounded.
    ScoreGradient(const ChangedScenes& scenes, std::optional<std::uint64_t> seed)
        : bands_(scenes.bands()),
          scores_(scenes),
          step_(seed
                    ? std::max<std::size_t>(1, (scenes.changes() + k_changes_per_contribution - 1) /
                                                   k_changes_per_contribution)
                    : 1),
          offset_(seed ? PathRandom(*seed, 0).next() : 0),
          score_(scenes.changes() * scenes.bands()),
          sums_(scenes.changes()) {}

    int add_vertex(int before, const PathVertex& vertex) override {
        if (before == k_no_vertex) scores_.begin();
        return scores_.add_vertex(before, vertex);
    }
    void add(const PathContribution& contribution, std::span<const double> sensitivity) override {
        const auto steps = static_cast<double>(step_);
        const std::size_t first = std::min(static_cast<std::size_t>(offset_ * steps), step_ - 1);
        // A golden-ratio sequence distributes the changes evenly over consecutive contributions,
        // and over those of every other lamp.
        constexpr double k_golden_ratio = 0.6180339887498949;
        offset_ += offset_ < 1 - k_golden_ratio ? k_golden_ratio : k_golden_ratio - 1;
        scores_.find(contribution, {first, step_}, score_);
        for (std::size_t i = first; i < sums_.size(); i += step_)
            for (std::size_t b = 0; b < bands_; ++b)
                sums_[i] += steps * sensitivity[b] * score_[i * bands_ + b];
    }
    void finish() override {}

    /// The derivatives, by change of the scenes.
    std::span<const double> by_change() const { return sums_; }

  private:
    static constexpr std::size_t k_changes_per_contribution = 8;

    std::size_t bands_;
    PathScores scores_;
    std::size_t step_;
    double offset_;  // which of the changes are next, in [0, 1)
    std::vector<double> score_, sums_;
};

}  // namespace uw
