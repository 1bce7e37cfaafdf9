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
    int dx = 0, dy = 0;  // offset from that node, in steps of the lattice
    double value = 0;    // that decides how wide the fit is
    double variance = 0;
    std::size_t index = 0;  // the caller's
    double weight = 1;      // relative to other nodes; > 0
};

/// A node's weight in a fitted value.
struct FitWeight {
    std::size_t index = 0;
    double weight = 0;
};

/// Smooths noisy estimates at the nodes of a lattice by fitting polynomials to the nodes around
/// each: a constant, a plane or a quadric, as far as the nodes determine it. The neighbourhood is
/// the widest whose fit agrees with those of all narrower ones to within their noise (Lepski 1991),
/// so that features are kept and noise is not. Storage is reused.
class LatticeFit {
  public:
    /// The maximum radius of neighbourhoods in steps of the lattice; callers pass the nodes within
    /// it.
    static constexpr int k_max_radius = 8;

    /// Fits the value at (0, 0). `nodes`, the nearest first, need not include that place.
    /// `tolerance`: a difference that does not matter, in units of `value`; where the noise is well
    /// below it, the neighbourhood stays narrow.
    void fit(std::span<const FitNode> nodes, double tolerance);
    /// Fits it in the neighbourhood of `radius`, one that fit() chose, whatever the nodes show.
    void fit_within(std::span<const FitNode> nodes, int radius);

    /// The weights of the nodes in the fitted value; they add up to 1. Empty without nodes.
    std::span<const FitWeight> weights() const { return weights_; }
    /// The radius of the last fit; -1 without nodes.
    int radius() const { return radius_; }
    /// The variance of the last fitted value.
    double variance() const { return variance_; }
    /// The weights of the fit that was accepted before the last, in a narrower neighbourhood. The
    /// difference of the two shows by how much the wider one smooths out features. Empty if there
    /// is none.
    std::span<const FitWeight> narrower() const { return narrower_; }

  private:
    // Fits the polynomial of the highest degree that the nodes within the radius determine.
    bool try_within(std::span<const FitNode> nodes, int radius);
    template <std::size_t k_terms>
    bool try_polynomial(std::span<const FitNode> nodes, int radius);
    void accept_tried(int radius);
    void clear();

    std::vector<FitWeight> weights_, narrower_, tried_;
    CholeskyFactor cholesky_;
    int radius_ = -1;
    double variance_ = 0;
    double tried_variance_ = 0, tried_value_ = 0;
};

}  // namespace uw
