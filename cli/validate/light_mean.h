#pragma once

#include <cmath>
#include <cstddef>

namespace uw {

/// The mean of independent estimates, and its standard error by their spread.
class LightMean {
  public:
    /// By Welford's recurrence: means that differ little keep their digits.
    void add(double estimate) {
        ++count_;
        const double before = estimate - mean_;
        mean_ += before / static_cast<double>(count_);
        squares_ += before * (estimate - mean_);
    }
    double mean() const { return mean_; }
    /// Of the mean; 0 for fewer than two estimates.
    double error() const {
        if (count_ < 2) return 0;
        return std::sqrt(squares_ / static_cast<double>(count_ * (count_ - 1)));
    }

  private:
    std::size_t count_ = 0;
    double mean_ = 0, squares_ = 0;
};

}  // namespace uw
