#pragma once

#include <array>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace uw {

/// Robust non-linear least squares, by Ceres in a module that is loaded when it is needed.

/// The function to be minimised: residuals in groups, such as the two coordinates of a corner. All
/// depend on the shared unknowns; a group may depend on a block of six unknowns besides, the motion
/// of its board, which it has in common with the other groups of that block.
class ResidualFunction {
  public:
    static constexpr std::size_t k_block_size = 6;
    using Block = std::array<double, k_block_size>;

    ResidualFunction() = default;
    virtual ~ResidualFunction() = default;
    ResidualFunction(const ResidualFunction&) = delete;
    ResidualFunction& operator=(const ResidualFunction&) = delete;
    ResidualFunction(ResidualFunction&&) = delete;
    ResidualFunction& operator=(ResidualFunction&&) = delete;

    /// To be called before groups are evaluated for these shared unknowns. False if they do not
    /// describe a valid scene.
    virtual bool prepare(std::span<const double> shared, bool with_derivatives) = 0;

    /// The residuals of a group, in units of their standard deviation, and, unless they are null,
    /// their derivatives by the shared unknowns and by its block, a row per residual. False if they
    /// cannot be computed. Thread safe.
    virtual bool evaluate(std::size_t group, const Block* block, double* residuals,
                          double* by_shared, double* by_block) const = 0;
};

/// A group of residuals: how many there are, and the block that they depend on; -1: none.
struct ResidualGroup {
    int residuals = 0;
    int block = -1;
    bool is_left_out = false;  // an outlier
};

struct LeastSquaresProblem {
    struct Unknown {
        double value = 0;  // where to begin; then what was found
        double lower = -std::numeric_limits<double>::infinity();
        double upper = std::numeric_limits<double>::infinity();
        /// Its prior; none if the deviation is infinite.
        double prior_mean = 0, prior_deviation = std::numeric_limits<double>::infinity();
    };
    std::vector<Unknown> shared;
    std::vector<ResidualFunction::Block> blocks;
    std::vector<ResidualGroup> groups;
    /// The scale of Cauchy's loss, beyond which groups lose weight [standard deviations]; infinite:
    /// plain squares.
    double loss_scale = std::numeric_limits<double>::infinity();
    int max_iterations = 100;
    double tolerance = 1e-10;  // of the sum's relative change: then it has converged
    bool is_rough = false;     // the sum may rise for a few steps: it has noise
    int threads = 1;
    std::function<void(int iteration, double cost)> progress{};  // may throw
};

/// The outcome of a problem, whose unknowns then have the values found.
struct LeastSquaresOutcome {
    bool converged = false;
    int iterations = 0;
    double cost = 0;  // half the sum of the squares, or of what the loss makes of them
    /// The shared unknowns' information, J^T J without what the blocks can explain as well (the
    /// Schur complement) and without priors, row by row; outliers and the loss do not count.
    std::vector<double> information;
};

/// Throws what `function` and `progress` throw, UsageError if the module is not there, and
/// InputError if the solver cannot begin: the first values are impossible.
LeastSquaresOutcome solve_least_squares(ResidualFunction& function, LeastSquaresProblem& problem);

/// Eigenvalues, ascending, and unit eigenvectors, one after the other, of a symmetric matrix.
struct EigenSystem {
    std::vector<double> values, vectors;
};
/// `matrix`: n x n numbers. Throws UsageError as above.
EigenSystem symmetric_eigen_system(std::span<const double> matrix);

/// Points whose images in a pinhole camera are known.
struct SeenPoints {
    std::vector<std::array<double, 3>> points;  // x, y, z in the body's own axes
    std::vector<std::array<double, 2>> images;  // x/z, y/z of the directions to them
};
/// camera_from_body as a rotation matrix, row by row, and the translation behind it.
using RigidMatrix = std::array<double, 12>;
/// The camera poses that explain the images of points, the best first; none if they do not
/// determine it. Throws UsageError as above.
std::vector<RigidMatrix> poses_from_points(const SeenPoints& seen);

/// A function that the module exports under this name. Throws UsageError if it is not there.
void* address_in_fitting(const char* symbol);
template <class Function>
Function& function_of_fitting(const char* symbol) {
    return *reinterpret_cast<Function*>(address_in_fitting(symbol));
}

/// The functions that the module exports: each stores the message of an error in `fault`.
namespace min_squares_module {
inline constexpr const char* k_name = "uwvdb_fitting";
inline constexpr const char* k_solve = "uwvdb_solve_least_squares";
using Solve = void(ResidualFunction& function, LeastSquaresProblem& problem,
                   LeastSquaresOutcome& outcome, std::exception_ptr& fault);
inline constexpr const char* k_eigen = "uwvdb_symmetric_eigen_system";
using Eigen = void(std::span<const double> matrix, EigenSystem& system);
inline constexpr const char* k_poses = "uwvdb_poses_from_points";
using Poses = void(const SeenPoints& seen, std::vector<RigidMatrix>& poses);
}  // namespace min_squares_module

}  // namespace uw
