#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace uw {

/// Solves small systems with a symmetric, positive definite matrix, such as the normal equations of
/// least squares, by Cholesky's factor. Reused storage.
class CholeskyFactor {
  public:
    /// Factors a matrix of `size` rows of `size` numbers, of which the lower triangle is read.
    /// False, and then there is no factor, if it is nearly singular: if what elimination leaves of
    /// an element of the diagonal is not above `least_pivot` times that element.
    bool factor(std::span<const double> matrix, std::size_t size, double least_pivot);

    /// Replaces a right-hand side by the solution. Precondition: there is a factor, of its size.
    void solve(std::span<double> x) const;

  private:
    std::size_t size_ = 0;
    std::vector<double> lower_;
};

}  // namespace uw
