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
    /// an element of the diagonal is not above `min_pivot` times that element.
    bool factor(std::span<const double> matrix, std::size_t size, double min_pivot);

    /// Replaces a right-hand side by the solution. Precondition: there is a factor, of its size.
    void solve(std::span<double> x) const;

  private:
    std::size_t size_ = 0;
    std::vector<double> lower_;
};

/// A node of a regular lattice near the one that is fitted.
struct FitNode {
    int dx = 0, dy = 0;  // from it, in steps of the lattice
    double value = 0;    // representative of all that is fitted
    double variance = 0;
    std::size_t index = 0;  // the caller's
    double weight = 1;      // in the fit, relative to others; > 0
};

/// A node's share in a fitted value.
struct FitWeight {
    std::size_t index = 0;
    double weight = 0;
};

/// Smooths noisy estimates at the nodes of a lattice by fitting polynomials to those around each:
/// a constant, a plane, or a quadric, as far as there are nodes for it. Of the neighbourhoods, the
/// widest is taken whose fit agrees with those of all narrower ones to within their noise
/// (Lepski 1991): features of the light are kept, noise is not. Reused storage.
class LatticeFit {
  public:
    /// The radius of neighbourhoods in steps of the lattice; a caller passes the nodes within it.
    static constexpr int k_reach = 8;

    /// The weights with which the nodes make up the fitted value at (0, 0), the sum of which is 1.
    /// `nodes`, the nearest first, need not include that place. `tolerance`: differences that do
    /// not matter, in units of `value`; where the noise is well below, narrower neighbourhoods will
    /// do. Empty without nodes.
    std::span<const FitWeight> fit(std::span<const FitNode> nodes, double tolerance);

    /// The variance of the last fitted value.
    double variance() const { return variance_; }
    /// The weights of the fit that was accepted before it, in a narrower neighbourhood: what the
    /// two differ by tells what the wider one takes from features. Empty if there is none.
    std::span<const FitWeight> narrower() const { return narrower_; }

  private:
    template <std::size_t k_terms>
    bool fit_within(std::span<const FitNode> nodes, int reach);

    std::vector<FitWeight> weights_, narrower_, tried_;
    CholeskyFactor cholesky_;
    double variance_ = 0;
    double tried_variance_ = 0, tried_value_ = 0;
};

}  // namespace uw
