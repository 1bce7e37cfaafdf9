#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "fit/least_squares.h"
#include "fit/unknowns.h"

namespace uw {

/// Observations compared with the predictions of a scene: residuals in units of a standard
/// deviation that is not known beforehand.
class Observations : public ResidualFunction {
  public:
    /// The image and the position at which something was observed.
    struct Place {
        std::size_t image = 0;
        ImagePoint at;  // the image's corner is (0, 0) [pixels]
    };

    virtual std::vector<ResidualGroup> groups() const = 0;
    virtual std::size_t block_count() const = 0;

    virtual const std::vector<std::string>& images() const = 0;
    virtual Place place(std::size_t group) const = 0;
    /// What is observed, "point"; the residuals' unit, "px"; and what residuals of `rms` in each
    /// number amount to in all of a group's.
    virtual const char* noun() const = 0;
    virtual const char* unit() const = 0;
    virtual double of_group(double rms) const = 0;

    /// The values from which weights are computed. If noise grows with the signal, as that of light
    /// does, weights by observation favour observations that are low by chance, which biases the
    /// result downwards; weights by prediction do not.
    enum class Weights { by_observation, by_prediction };
    /// Computes weights from the observations, or from the last predictions.
    virtual void weigh(Weights /*by*/) {}

    /// Whether predictions have noise of their own, which changes with the unknowns.
    virtual bool is_rough() const { return false; }
    /// The factor, at least 1, by which correlations of neighbouring residuals increase the
    /// variance of the result; 1 for independent ones. `residuals` of all groups, `outliers` per
    /// group.
    virtual double clustering(std::span<const double> /*residuals*/,
                              const std::vector<bool>& /*outliers*/) const {
        return 1;
    }

    /// The standard deviation of a residual, in the observations' own unit.
    void set_deviation(double deviation) { deviation_ = deviation; }
    double deviation() const { return deviation_; }

  private:
    double deviation_ = 1;
};

/// Prior knowledge of an unknown.
struct Prior {
    double mean = 0;
    double deviation = std::numeric_limits<double>::infinity();
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();
};

struct FitOptions {
    std::vector<Prior> priors;    // one per unknown, or none
    bool keeps_outliers = false;  // all observations count, whatever they are of
    int starts = 1;               // from how many places to begin; all but the first at random
    std::uint64_t seed = 0;
    int threads = 1;
    std::function<void(const std::string& stage, double cost)> progress{};
};

/// An unknown as it was found.
struct FoundValue {
    SceneUnknown unknown;
    double value = 0;
    double error = 0;            // standard error; infinite if it is not determined
    double prior_deviation = 0;  // infinite: none
    bool is_at_bound = false;
    /// The size with which its errors are compared: the greatest value of its list as found, > 0.
    double size = 1;
};

/// Unknowns of which only a combination is determined: moved together by these components of their
/// sizes, they leave the observations unchanged.
struct FreeDirection {
    std::vector<std::size_t> unknowns;  // most affected first
    std::vector<double> components;     // likewise, of unit length
    /// The standard error along it, in sizes; infinite if it is not determined at all.
    double error = 0;
};

using BlockCovariance =
    std::array<double, ResidualFunction::k_block_size * ResidualFunction::k_block_size>;

struct FitResult {
    bool converged = false;
    std::vector<FoundValue> values;
    std::vector<double> correlations;  // n x n
    std::vector<FreeDirection> free_directions;
    std::vector<ResidualFunction::Block> blocks;
    /// The covariances of each, 6 x 6 row by row, the unknowns' errors included; infinite if they
    /// are not determined.
    std::vector<BlockCovariance> block_covariances;
    std::vector<double> residuals;          // of all groups, in the observations' unit
    std::vector<bool> outliers;             // per group
    double rms = 0, rms_with_outliers = 0;  // over residuals, in the observations' unit
    double deviation = 0;   // of a residual, estimated: with as many fewer as there are unknowns
    double clustering = 1;  // Observations::clustering, included in the errors
    double rms_at_start = 0;
    int iterations = 0;
    std::vector<double> costs;  // of each start, as found
};

/// Finds the unknowns by least squares that outliers do not spoil: rounds with Cauchy's loss, whose
/// scale follows the median of the residuals, until that stays the same; then, without those
/// beyond five standard deviations, plain squares, to which the standard errors belong. Throws as
/// solve_least_squares, and what observations throw.
FitResult robust_fit(Observations& observations, const SceneUnknowns& unknowns,
                     const FitOptions& options);

}  // namespace uw
