#include <ceres/ceres.h>
#include <glog/logging.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <vector>

#include "core/base/error.h"
#include "fit/least_squares.h"

namespace {

using uw::LeastSquaresOutcome;
using uw::LeastSquaresProblem;
using uw::ResidualFunction;

constexpr int k_block_size = static_cast<int>(ResidualFunction::k_block_size);

/// The function as Ceres asks for it. Keeps the first exception of any thread, after which
/// everything is impossible, so that none passes through Ceres.
class GuardedFunction final : public ceres::EvaluationCallback {
  public:
    explicit GuardedFunction(ResidualFunction& function, const std::vector<double>& shared)
        : function_(function), shared_(shared) {}

    void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override {
        if (!new_evaluation_point && possible_ && has_derivatives_ >= evaluate_jacobians) return;
        has_derivatives_ = evaluate_jacobians;
        possible_ = guarded([&] { return function_.prepare(shared_, evaluate_jacobians); });
    }
    bool evaluate(std::size_t group, const double* block, double* residuals, double* by_shared,
                  double* by_block) {
        if (!possible_) return false;
        return guarded([&] {
            ResidualFunction::Block values{};
            if (block != nullptr) std::copy_n(block, k_block_size, values.begin());
            return function_.evaluate(group, block != nullptr ? &values : nullptr, residuals,
                                      by_shared, by_block);
        });
    }
    /// Runs `work`, and keeps what it throws.
    template <class Work>
    bool guarded(const Work& work) {
        try {
            return work();
        } catch (...) {
            const std::scoped_lock lock(mutex_);
            if (!fault_) fault_ = std::current_exception();
            return false;
        }
    }
    const std::exception_ptr& fault() const { return fault_; }

  private:
    ResidualFunction& function_;
    const std::vector<double>& shared_;
    bool possible_ = false, has_derivatives_ = false;
    std::mutex mutex_;
    std::exception_ptr fault_;
};

/// One group. Its parameter blocks are those of the shared unknowns, if there are any, and its own.
class GroupCost final : public ceres::CostFunction {
  public:
    GroupCost(GuardedFunction& function, std::size_t index, const uw::ResidualGroup& group,
              std::size_t shared_count)
        : function_(function), index_(index), has_shared_(shared_count > 0) {
        set_num_residuals(group.residuals);
        if (has_shared_) mutable_parameter_block_sizes()->push_back(static_cast<int>(shared_count));
        if (group.block >= 0) mutable_parameter_block_sizes()->push_back(k_block_size);
    }

    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override {
        const std::size_t own = has_shared_ ? 1 : 0;
        const bool has_block = parameter_block_sizes().size() > own;
        double* by_shared = jacobians != nullptr && has_shared_ ? jacobians[0] : nullptr;
        double* by_block = jacobians != nullptr && has_block ? jacobians[own] : nullptr;
        return function_.evaluate(index_, has_block ? parameters[own] : nullptr, residuals,
                                  by_shared, by_block);
    }

  private:
    GuardedFunction& function_;
    std::size_t index_;
    bool has_shared_;
};

/// What is known of the shared unknowns beforehand.
class PriorCost final : public ceres::CostFunction {
  public:
    explicit PriorCost(const std::vector<LeastSquaresProblem::Unknown>& unknowns)
        : unknowns_(unknowns) {
        set_num_residuals(static_cast<int>(unknowns.size()));
        mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns.size()));
    }

    bool Evaluate(double const* const* parameters, double* residuals,
                  double** jacobians) const override {
        const std::size_t n = unknowns_.size();
        for (std::size_t i = 0; i < n; ++i)
            residuals[i] =
                (parameters[0][i] - unknowns_[i].prior_mean) / unknowns_[i].prior_deviation;
        if (jacobians != nullptr && jacobians[0] != nullptr) {
            std::fill_n(jacobians[0], n * n, 0.0);
            for (std::size_t i = 0; i < n; ++i)
                jacobians[0][i * n + i] = 1 / unknowns_[i].prior_deviation;
        }
        return true;
    }

  private:
    std::vector<LeastSquaresProblem::Unknown> unknowns_;
};

/// Tells the caller of each iteration, and ends at a fault.
class Watcher final : public ceres::IterationCallback {
  public:
    Watcher(GuardedFunction& function, const LeastSquaresProblem& problem)
        : function_(function), problem_(problem) {}
    ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
        if (!function_.fault() && problem_.progress)
            function_.guarded([&] {
                problem_.progress(summary.iteration, summary.cost);
                return true;
            });
        return function_.fault() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
    }

  private:
    GuardedFunction& function_;
    const LeastSquaresProblem& problem_;
};

/// J^T J of the shared unknowns where the blocks are free.
std::vector<double> shared_information(GuardedFunction& function,
                                       const LeastSquaresProblem& problem) {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto n = static_cast<Eigen::Index>(problem.shared.size());
    function.PrepareForEvaluation(true, true);
    Matrix information = Matrix::Zero(n, n);
    struct Own {
        Matrix mixed, own;
    };
    std::vector<Own> blocks(problem.blocks.size(), {Matrix::Zero(n, k_block_size),
                                                    Matrix::Zero(k_block_size, k_block_size)});
    for (std::size_t i = 0; i < problem.groups.size(); ++i) {
        const uw::ResidualGroup& group = problem.groups[i];
        if (group.is_left_out) continue;
        Eigen::VectorXd residuals(group.residuals);
        Matrix by_shared(group.residuals, n), by_block(group.residuals, k_block_size);
        const bool has_block = group.block >= 0;
        const auto block = static_cast<std::size_t>(has_block ? group.block : 0);
        if (!function.evaluate(i, has_block ? problem.blocks[block].data() : nullptr,
                               residuals.data(), by_shared.data(),
                               has_block ? by_block.data() : nullptr))
            continue;
        information += by_shared.transpose() * by_shared;
        if (!has_block) continue;
        blocks[block].mixed += by_shared.transpose() * by_block;
        blocks[block].own += by_block.transpose() * by_block;
    }
    for (const Own& block : blocks) {
        // Blocks that their own points leave undetermined explain what they can.
        const Eigen::SelfAdjointEigenSolver<Matrix> own(block.own);
        const double greatest = own.eigenvalues().maxCoeff();
        if (!(greatest > 0)) continue;
        const Matrix mixed = block.mixed * own.eigenvectors();
        for (int k = 0; k < k_block_size; ++k)
            if (own.eigenvalues()[k] > 1e-12 * greatest)
                information -= mixed.col(k) * mixed.col(k).transpose() / own.eigenvalues()[k];
    }
    return {information.data(), information.data() + n * n};
}

void solve(ResidualFunction& residual_function, LeastSquaresProblem& problem,
           LeastSquaresOutcome& outcome, std::exception_ptr& fault) {
    FLAGS_minloglevel = google::GLOG_FATAL;  // what went wrong is for us to say
    const std::size_t n = problem.shared.size();
    std::vector<double> shared;
    for (const LeastSquaresProblem::Unknown& unknown : problem.shared)
        shared.push_back(std::clamp(unknown.value, unknown.lower, unknown.upper));
    GuardedFunction function(residual_function, shared);
    ceres::Problem::Options ownership;
    ownership.evaluation_callback = &function;
    ceres::Problem all(ownership);
    ceres::Solver::Options options;
    auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (std::size_t i = 0; i < problem.groups.size(); ++i) {
        const uw::ResidualGroup& group = problem.groups[i];
        if (group.is_left_out) continue;
        std::vector<double*> parameters;
        if (n > 0) parameters.push_back(shared.data());
        if (group.block >= 0)
            parameters.push_back(problem.blocks[static_cast<std::size_t>(group.block)].data());
        if (parameters.empty()) continue;
        all.AddResidualBlock(
            new GroupCost(function, i, group, n),
            std::isfinite(problem.loss_scale) ? new ceres::CauchyLoss(problem.loss_scale) : nullptr,
            parameters);
        if (group.block >= 0) ordering->AddElementToGroup(parameters.back(), 0);
    }
    if (n > 0 && all.HasParameterBlock(shared.data())) {
        all.AddResidualBlock(new PriorCost(problem.shared), nullptr, shared.data());
        ordering->AddElementToGroup(shared.data(), 1);
        for (std::size_t i = 0; i < n; ++i) {
            const auto at = static_cast<int>(i);
            if (std::isfinite(problem.shared[i].lower))
                all.SetParameterLowerBound(shared.data(), at, problem.shared[i].lower);
            if (std::isfinite(problem.shared[i].upper))
                all.SetParameterUpperBound(shared.data(), at, problem.shared[i].upper);
        }
    }
    options.linear_solver_type = problem.blocks.empty() ? ceres::DENSE_QR : ceres::DENSE_SCHUR;
    options.linear_solver_ordering = ordering;
    options.max_num_iterations = problem.max_iterations;
    options.max_num_consecutive_invalid_steps = 20;
    options.use_nonmonotonic_steps = problem.is_rough;
    options.function_tolerance = problem.tolerance;
    options.parameter_tolerance = 1e-10;
    options.num_threads = problem.threads;
    options.logging_type = ceres::SILENT;
    options.update_state_every_iteration = false;
    Watcher watcher(function, problem);
    options.callbacks.push_back(&watcher);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &all, &summary);
    fault = function.fault();
    if (!fault && summary.termination_type == ceres::FAILURE)
        fault = std::make_exception_ptr(uw::InputError(
            "the fit cannot begin: the scene as it is does not predict what was observed; check "
            "that its start values are about right"));
    for (std::size_t i = 0; i < n; ++i) problem.shared[i].value = shared[i];
    outcome.converged = summary.termination_type == ceres::CONVERGENCE;
    outcome.iterations = static_cast<int>(summary.iterations.size());
    outcome.cost = summary.final_cost;
    if (!fault) {
        outcome.information = shared_information(function, problem);
        fault = function.fault();
    }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void uwvdb_solve_least_squares(
    ResidualFunction& function, LeastSquaresProblem& problem, LeastSquaresOutcome& outcome,
    std::exception_ptr& fault) {
    try {
        solve(function, problem, outcome, fault);
    } catch (...) {
        fault = std::current_exception();
    }
}

extern "C" __attribute__((visibility("default"))) void uwvdb_symmetric_eigen_system(
    std::span<const double> matrix, uw::EigenSystem& system) {
    const auto n = static_cast<Eigen::Index>(std::lround(std::sqrt(matrix.size())));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
        Eigen::Map<const Eigen::MatrixXd>(matrix.data(), n, n));
    const double* const values = solver.eigenvalues().data();
    const double* const vectors = solver.eigenvectors().data();  // column by column
    system.values.assign(values, values + n);
    system.vectors.assign(vectors, vectors + n * n);
}
