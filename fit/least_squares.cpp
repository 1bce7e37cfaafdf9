#include "fit/least_squares.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/troubleshooting.h"
#include "core/image/loaded_module.h"

namespace uw {

void* address_in_fitting(const char* symbol) {
    const ModuleFunction found = load_function(min_squares_module::k_name, symbol);
    if (found.address == nullptr)
        throw UsageError(fmt::format("fitting needs Ceres and OpenCV ({}); {}{}", found.fault,
                                     how_to_install("uwvdb-fitting"),
                                     see_troubleshooting("Installing")));
    return found.address;
}

LeastSquaresOutcome solve_least_squares(ResidualFunction& function, LeastSquaresProblem& problem) {
    auto& solve = function_of_fitting<min_squares_module::Solve>(min_squares_module::k_solve);
    LeastSquaresOutcome outcome;
    std::exception_ptr fault;
    solve(function, problem, outcome, fault);
    if (fault) std::rethrow_exception(fault);
    return outcome;
}

EigenSystem symmetric_eigen_system(std::span<const double> matrix) {
    auto& solve = function_of_fitting<min_squares_module::Eigen>(min_squares_module::k_eigen);
    EigenSystem system;
    solve(matrix, system);
    return system;
}

std::vector<RigidMatrix> poses_from_points(const SeenPoints& seen) {
    auto& find = function_of_fitting<min_squares_module::Poses>(min_squares_module::k_poses);
    std::vector<RigidMatrix> poses;
    find(seen, poses);
    return poses;
}

}  // namespace uw
