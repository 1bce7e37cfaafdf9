#include "fit/robust_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"

namespace uw {

namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
/// Beyond this many standard deviations an observation is an outlier.
constexpr double k_outlier = 5;
/// The scale at which Cauchy's loss has 95 % of the efficiency of squares for normal residuals.
constexpr double k_cauchy = 2.385;

/// Relative changes of the sum at which it has converged; where it is rough, the first at all
/// times.
constexpr double k_on_the_way = 1e-4, k_in_the_end = 1e-8;

/// Residuals of all groups as a problem's unknowns have them, in the observations' unit; infinite
/// where there are none.
std::vector<double> residuals_of(Observations& observations, const LeastSquaresProblem& problem) {
    std::vector<double> shared;
    for (const LeastSquaresProblem::Unknown& unknown : problem.shared)
        shared.push_back(unknown.value);
    std::vector<double> all;
    const bool is_possible = observations.prepare(shared, false);
    for (std::size_t i = 0; i < problem.groups.size(); ++i) {
        const ResidualGroup& group = problem.groups[i];
        std::vector<double> some(static_cast<std::size_t>(group.residuals), k_infinity);
        const ResidualFunction::Block* const block =
            group.block >= 0 ? &problem.blocks[static_cast<std::size_t>(group.block)] : nullptr;
        if (!is_possible || !observations.evaluate(i, block, some.data(), nullptr, nullptr))
            std::ranges::fill(some, k_infinity);
        for (const double one : some) all.push_back(one * observations.deviation());
    }
    return all;
}

/// The same, with weights from the predictions of the unknowns.
std::vector<double> weighed_residuals(Observations& observations,
                                      const LeastSquaresProblem& problem) {
    residuals_of(observations, problem);  // makes this the last prediction
    observations.weigh(Observations::Weights::by_prediction);
    return residuals_of(observations, problem);
}

/// The deviation of normal numbers of whose magnitudes this is the median.
double robust_deviation(std::span<const double> residuals) {
    std::vector<double> magnitudes;
    for (const double residual : residuals)
        if (std::isfinite(residual)) magnitudes.push_back(std::abs(residual));
    if (magnitudes.empty()) return 0;
    const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
    std::ranges::nth_element(magnitudes, middle);
    constexpr double k_normal = 1.4826;  // 1 / the median of a normal number's magnitude
    return k_normal * *middle;
}

double rms_of(std::span<const double> residuals) {
    double squares = 0;
    for (const double residual : residuals) squares += residual * residual;
    return residuals.empty() ? 0 : std::sqrt(squares / static_cast<double>(residuals.size()));
}

/// Those of groups that are not left out.
std::vector<double> without_outliers(std::span<const double> residuals,
                                     std::span<const ResidualGroup> groups) {
    std::vector<double> kept;
    std::size_t at = 0;
    for (const ResidualGroup& group : groups) {
        const auto count = static_cast<std::size_t>(group.residuals);
        if (!group.is_left_out)
            kept.insert(kept.end(), residuals.begin() + static_cast<std::ptrdiff_t>(at),
                        residuals.begin() + static_cast<std::ptrdiff_t>(at + count));
        at += count;
    }
    return kept;
}

void leave_out_outliers(std::span<const double> residuals, double deviation,
                        std::vector<ResidualGroup>& groups) {
    std::size_t at = 0;
    for (ResidualGroup& group : groups) {
        group.is_left_out = false;
        for (int i = 0; i < group.residuals; ++i, ++at)
            if (!(std::abs(residuals[at]) <= k_outlier * deviation)) group.is_left_out = true;
    }
}

class Rounds {
  public:
    Rounds(Observations& observations, LeastSquaresProblem& problem, const FitOptions& options)
        : observations_(observations), problem_(problem), options_(options) {}

    LeastSquaresOutcome solve() {
        observations_.set_deviation(1);
        observations_.weigh(Observations::Weights::by_observation);
        // Squares converge from far away; the observations that are far off afterwards are
        // outliers.
        LeastSquaresOutcome outcome = round("squares", k_infinity, k_on_the_way);
        double deviation = deviation_now();
        if (options_.keeps_outliers) {
            observations_.set_deviation(deviation > 0 ? deviation : 1);
            return round("standard errors", k_infinity, k_in_the_end);
        }
        constexpr int k_max_rounds = 8;
        for (int i = 0; i < k_max_rounds && deviation > 0; ++i) {
            observations_.set_deviation(deviation);
            outcome = round("without outliers", k_cauchy, k_on_the_way);
            const double before = std::exchange(deviation, deviation_now());
            if (std::abs(deviation - before) <= 0.02 * before) break;
        }
        if (!(deviation > 0)) return outcome;
        leave_out_outliers(residuals_of(observations_, problem_), deviation, problem_.groups);
        observations_.set_deviation(deviation);
        return round("standard errors", k_infinity, k_in_the_end);
    }

    int iterations() const { return iterations_; }

  private:
    LeastSquaresOutcome round(const char* stage, double loss_scale, double tolerance) {
        problem_.loss_scale = loss_scale;
        problem_.is_rough = observations_.is_rough();
        problem_.tolerance = problem_.is_rough ? k_on_the_way : tolerance;
        problem_.max_iterations = tolerance < k_on_the_way ? 100 : 25;
        if (options_.progress)
            problem_.progress = [&, stage](int, double cost) { options_.progress(stage, cost); };
        LeastSquaresOutcome outcome = solve_least_squares(observations_, problem_);
        iterations_ += outcome.iterations;
        return outcome;
    }
    double deviation_now() { return robust_deviation(weighed_residuals(observations_, problem_)); }

    Observations& observations_;
    LeastSquaresProblem& problem_;
    const FitOptions& options_;
    int iterations_ = 0;
};

/// Standard errors and correlations from the information, in units of the residuals' `deviation`
/// as it was assumed.
void find_errors(const LeastSquaresOutcome& outcome, FitResult& result) {
    const std::size_t n = result.values.size();
    if (n == 0) return;
    // In sizes of the unknowns, so that its eigenvalues are comparable.
    std::vector<double> information = outcome.information;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            information[i * n + j] *= result.values[i].size * result.values[j].size;
            if (i == j)
                information[i * n + j] +=
                    std::pow(result.values[i].size / result.values[i].prior_deviation, 2);
        }
    const EigenSystem system = symmetric_eigen_system(information);
    const double greatest = std::max(system.values.back(), 0.0);
    std::vector<double> covariance(n * n, 0.0);
    std::vector<bool> is_free(n, false);
    for (std::size_t k = 0; k < n; ++k) {
        const std::span vector = std::span(system.vectors).subspan(k * n, n);
        // Directions below rounding are undetermined; those with errors above the unknowns' own
        // sizes practically so.
        const bool is_nothing = !(system.values[k] > 1e-13 * greatest);
        const double error = is_nothing ? k_infinity : 1 / std::sqrt(system.values[k]);
        if (error > 1) {
            FreeDirection direction;
            direction.error = error;
            constexpr double k_counts = 0.2;  // of the most affected
            double most = 0;
            for (const double component : vector) most = std::max(most, std::abs(component));
            for (std::size_t i = 0; i < n; ++i)
                if (std::abs(vector[i]) > k_counts * most) direction.unknowns.push_back(i);
            std::ranges::sort(direction.unknowns, std::greater{},
                              [&](std::size_t i) { return std::abs(vector[i]); });
            for (const std::size_t i : direction.unknowns)
                direction.components.push_back(vector[i]);
            result.free_directions.push_back(std::move(direction));
        }
        if (is_nothing) {
            for (std::size_t i = 0; i < n; ++i)
                if (std::abs(vector[i]) > 1e-3) is_free[i] = true;
            continue;
        }
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                covariance[i * n + j] += vector[i] * vector[j] * error * error;
    }
    result.correlations.assign(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        FoundValue& found = result.values[i];
        found.error = is_free[i] ? k_infinity : std::sqrt(covariance[i * n + i]) * found.size;
        for (std::size_t j = 0; j < n; ++j) {
            const double both = std::sqrt(covariance[i * n + i] * covariance[j * n + j]);
            if (both > 0) result.correlations[i * n + j] = covariance[i * n + j] / both;
        }
    }
}

/// The list that a number of the scene is in, by its path; of others, their own names.
std::string list_of(const SceneUnknown& unknown) {
    return unknown.name.ends_with(']') ? unknown.name.substr(0, unknown.name.rfind('['))
                                       : unknown.name;
}

/// The size with which an error of each unknown is compared: the magnitude of the value found,
/// wherever the fit began. For a tilt it is in degrees; for a value near 0, such as the offset of a
/// port, it is a centimetre, or the initial scale if that is less.
void find_sizes(std::vector<FoundValue>& values) {
    constexpr double k_little = 0.01;  // as in SceneUnknowns: a centimetre, 1 % per metre
    for (FoundValue& found : values) {
        found.size = found.unknown.scale;
        if (!found.unknown.unit.empty()) continue;
        found.size = std::min(found.unknown.scale, k_little);
        for (const FoundValue& other : values)
            if (list_of(other.unknown) == list_of(found.unknown))
                found.size = std::max(found.size, std::abs(other.value));
    }
}

constexpr std::size_t k_block = ResidualFunction::k_block_size;

/// The inverse of a symmetric positive definite matrix; infinite if it is not.
BlockCovariance inverse_of(BlockCovariance matrix) {
    BlockCovariance inverse{};
    for (std::size_t i = 0; i < k_block; ++i) inverse[i * k_block + i] = 1;
    for (std::size_t pivot = 0; pivot < k_block; ++pivot) {
        const double value = matrix[pivot * k_block + pivot];
        if (!(value > 0)) {
            inverse.fill(k_infinity);
            return inverse;
        }
        for (std::size_t column = 0; column < k_block; ++column) {
            inverse[pivot * k_block + column] /= value;
            matrix[pivot * k_block + column] /= value;
        }
        for (std::size_t row = 0; row < k_block; ++row) {
            if (row == pivot) continue;
            const double factor = matrix[row * k_block + pivot];
            for (std::size_t column = 0; column < k_block; ++column) {
                inverse[row * k_block + column] -= factor * inverse[pivot * k_block + column];
                matrix[row * k_block + column] -= factor * matrix[pivot * k_block + column];
            }
        }
    }
    return inverse;
}

/// The covariances of the blocks: from their own observations for given unknowns, and from the
/// errors of the unknowns, which move the blocks.
void find_block_covariances(Observations& observations, const LeastSquaresProblem& problem,
                            double variance, FitResult& result) {
    const std::size_t n = result.values.size(), blocks = problem.blocks.size();
    if (blocks == 0) return;
    std::vector<double> shared;
    for (const FoundValue& found : result.values) shared.push_back(found.value);
    result.block_covariances.assign(blocks, {});
    for (BlockCovariance& covariance : result.block_covariances) covariance.fill(k_infinity);
    if (!observations.prepare(shared, true)) return;
    std::vector<BlockCovariance> own(blocks, BlockCovariance{});
    std::vector<std::vector<double>> both(blocks, std::vector<double>(k_block * n, 0.0));
    for (std::size_t i = 0; i < problem.groups.size(); ++i) {
        const ResidualGroup& group = problem.groups[i];
        if (group.is_left_out || group.block < 0) continue;
        const auto block = static_cast<std::size_t>(group.block);
        const auto count = static_cast<std::size_t>(group.residuals);
        std::vector<double> residuals(count), by_shared(count * n), by_block(count * k_block);
        if (!observations.evaluate(i, &problem.blocks[block], residuals.data(), by_shared.data(),
                                   by_block.data()))
            continue;
        for (std::size_t k = 0; k < count; ++k)
            for (std::size_t row = 0; row < k_block; ++row) {
                const double derivative = by_block[k * k_block + row];
                for (std::size_t column = 0; column < k_block; ++column)
                    own[block][row * k_block + column] +=
                        derivative * by_block[k * k_block + column];
                for (std::size_t column = 0; column < n; ++column)
                    both[block][row * n + column] += derivative * by_shared[k * n + column];
            }
    }
    for (std::size_t block = 0; block < blocks; ++block) {
        const BlockCovariance inverse = inverse_of(own[block]);
        if (!std::isfinite(inverse[0])) continue;
        // The displacement of the block by each unknown's error; infinite for undetermined
        // unknowns.
        std::vector<double> moved(k_block * n, 0.0);
        bool is_determined = true;
        for (std::size_t row = 0; row < k_block; ++row)
            for (std::size_t column = 0; column < n; ++column) {
                double sum = 0;
                for (std::size_t k = 0; k < k_block; ++k)
                    sum += inverse[row * k_block + k] * both[block][k * n + column];
                const double error = result.values[column].error;
                if (!std::isfinite(error))
                    is_determined =
                        is_determined && std::abs(sum) * result.values[column].size < 1e-9;
                else
                    moved[row * n + column] = sum * error;
            }
        if (!is_determined) continue;
        for (std::size_t row = 0; row < k_block; ++row)
            for (std::size_t column = 0; column < k_block; ++column) {
                double sum = variance * inverse[row * k_block + column];
                for (std::size_t i = 0; i < n; ++i)
                    for (std::size_t j = 0; j < n; ++j)
                        sum += moved[row * n + i] * result.correlations[i * n + j] *
                               moved[column * n + j];
                result.block_covariances[block][row * k_block + column] = sum;
            }
    }
}

LeastSquaresProblem problem_of(const Observations& observations, const SceneUnknowns& unknowns,
                               const FitOptions& options) {
    LeastSquaresProblem problem;
    problem.groups = observations.groups();
    problem.blocks.resize(observations.block_count());
    problem.threads = options.threads;
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
        const SceneUnknown& unknown = unknowns.all()[i];
        LeastSquaresProblem::Unknown shared{unknown.start, unknown.lower, unknown.upper};
        if (!options.priors.empty()) {
            const Prior& prior = options.priors[i];
            shared.lower = std::max(shared.lower, prior.lower);
            shared.upper = std::min(shared.upper, prior.upper);
            shared.prior_mean = prior.mean;
            shared.prior_deviation = prior.deviation;
        }
        problem.shared.push_back(shared);
    }
    return problem;
}

/// Draws a starting point: within the bounds if both are given, else within a third of the scale,
/// and within the prior.
void begin_elsewhere(LeastSquaresProblem& problem, const SceneUnknowns& unknowns,
                     std::uint64_t seed, int start) {
    for (std::size_t i = 0; i < problem.shared.size(); ++i) {
        LeastSquaresProblem::Unknown& unknown = problem.shared[i];
        const double u = draw_random(seed, unknowns.all()[i].name, 0, start);
        if (std::isfinite(unknown.lower) && std::isfinite(unknown.upper)) {
            unknown.value = unknown.lower + u * (unknown.upper - unknown.lower);
            continue;
        }
        const double width = std::min(unknowns.all()[i].scale / 3, unknown.prior_deviation);
        unknown.value =
            std::clamp(unknown.value + (2 * u - 1) * width, unknown.lower, unknown.upper);
    }
}

}  // namespace

FitResult robust_fit(Observations& observations, const SceneUnknowns& unknowns,
                     const FitOptions& options) {
    FitResult result;
    const LeastSquaresProblem first = problem_of(observations, unknowns, options);
    observations.set_deviation(1);
    result.rms_at_start = rms_of(residuals_of(observations, first));
    std::optional<LeastSquaresProblem> best;
    LeastSquaresOutcome outcome;
    double deviation = 1;
    for (int start = 0; start < options.starts; ++start) {
        LeastSquaresProblem problem = first;
        if (start > 0) begin_elsewhere(problem, unknowns, options.seed, start);
        Rounds rounds(observations, problem, options);
        LeastSquaresOutcome found;
        try {
            found = rounds.solve();
        } catch (const InputError&) {
            if (start == 0) throw;  // some of the other starts may fail
            continue;
        }
        result.iterations += rounds.iterations();
        const double now = observations.deviation();
        result.costs.push_back(now);
        if (best && now >= deviation) continue;
        best = std::move(problem);
        outcome = std::move(found);
        deviation = now;
    }
    observations.set_deviation(deviation);
    result.converged = outcome.converged;
    result.residuals = weighed_residuals(observations, *best);
    result.blocks = best->blocks;
    for (const ResidualGroup& group : best->groups) result.outliers.push_back(group.is_left_out);
    const std::vector<double> kept = without_outliers(result.residuals, best->groups);
    result.rms = rms_of(kept);
    result.rms_with_outliers = rms_of(result.residuals);
    const std::size_t free = best->shared.size() + 6 * best->blocks.size();
    result.deviation = kept.size() > free
                           ? std::sqrt(result.rms * result.rms * static_cast<double>(kept.size()) /
                                       static_cast<double>(kept.size() - free))
                           : k_infinity;
    for (std::size_t i = 0; i < best->shared.size(); ++i) {
        const LeastSquaresProblem::Unknown& shared = best->shared[i];
        FoundValue found{unknowns.all()[i], shared.value};
        found.prior_deviation = shared.prior_deviation;
        result.values.push_back(std::move(found));
    }
    find_sizes(result.values);
    for (std::size_t i = 0; i < best->shared.size(); ++i) {
        const LeastSquaresProblem::Unknown& shared = best->shared[i];
        const double little = 1e-6 * result.values[i].size;
        result.values[i].is_at_bound =
            shared.value < shared.lower + little || shared.value > shared.upper - little;
    }
    // The information is in units of the deviation that was assumed; priors are in their own.
    result.clustering = observations.clustering(result.residuals, result.outliers);
    const double ratio = deviation / result.deviation;
    for (double& entry : outcome.information) entry *= ratio * ratio / result.clustering;
    find_errors(outcome, result);
    find_block_covariances(observations, *best, 1 / (ratio * ratio), result);
    return result;
}

}  // namespace uw
