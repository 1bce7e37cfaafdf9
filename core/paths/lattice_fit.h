#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace uw {

/// Solves small linear systems with a symmetric positive definite matrix, such as normal equations
/// of least squares, by Cholesky factorisation. Storage is reused.
class CholeskyFactor {
  public:
    /// Factors a matrix of `size` rows of `size` numbers, of which only the lower triangle is read.
    /// Returns false, and leaves no valid factor, if the matrix is nearly singular: if elimination
    /// leaves no more than `min_pivot` times an element of the diagonal.
    bool factor(std::span<const double> matrix, std::size_t size, double min_pivot);

    /// Replaces a right-hand side by the solution. Precondition: factor() succeeded, with its size.
    void solve(std::span<double> x) const;

  private:
    std::size_t size_ = 0;
    std::vector<double> lower_;
};

/// A node of a regular lattice near the node that is fitted.
struct FitNode {
    int dx = 0, dy = 0;     // offset from that node, in steps of the lattice
    std::size_t index = 0;  // the caller's
    double weight = 1;      // relative to other nodes; > 0
};

/// A node's weight in a fitted value.
struct FitWeight {
    std::size_t index = 0;
    double weight = 0;
};

/// Smooths noisy estimates at the nodes of a lattice by fitting polynomials to the nodes around
/// each: a constant, a plane or a quadric, as far as the nodes determine it. Storage is reused.
class LatticeFit {
  public:
    /// Fits the value at (0, 0) to those of `nodes`, the nearest first, within a distance of
    /// `radius` steps; they need not include that place. Returns whether there are any.
    bool fit(std::span<const FitNode> nodes, int radius);

    /// The weights of the nodes in the value of the last fit; they add up to 1.
    std::span<const FitWeight> weights() const { return weights_; }

  private:
    template <std::size_t k_terms>
    bool fit_polynomial(std::span<const FitNode> nodes, int radius);

    std::vector<FitWeight> weights_;
    CholeskyFactor cholesky_;
};

}  // namespace uw
