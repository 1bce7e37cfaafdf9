#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace uw::test {

/// The means of independent batches of paths: what is estimated and its stated standard error.
class BatchMeans {
  public:
    void add(double mean) { means_.push_back(mean); }

    std::size_t count() const { return means_.size(); }
    double mean() const {
        double sum = 0;
        for (const double m : means_) sum += m;
        return sum / static_cast<double>(means_.size());
    }
    /// The standard error of mean().
    double error() const {
        const auto n = static_cast<double>(means_.size());
        return std::sqrt(central_moment(2) / (n - 1));
    }
    /// The kurtosis of the batches: 3 for normal ones.
    double kurtosis() const {
        const double variance = central_moment(2);
        return central_moment(4) / (variance * variance);
    }
    /// How far mean() is off `truth`, in standard errors; `truth_error` is that of the truth.
    double deviation(double truth, double truth_error = 0) const {
        return (mean() - truth) / std::hypot(error(), truth_error);
    }

  private:
    double central_moment(int power) const {
        const double m = mean();
        double sum = 0;
        for (const double value : means_) sum += std::pow(value - m, power);
        return sum / static_cast<double>(means_.size());
    }

    std::vector<double> means_;
};

/// Judges many estimates together. Each is held to three stated standard errors; of many, some
/// exceed them by chance: with 32 batches or more (Student's t) one in 190, and one in 2700
/// exceeds four.
class Deviations {
  public:
    void add(const std::string& what, const BatchMeans& estimate, double truth,
             double truth_error = 0) {
        add(what, estimate.mean(), std::hypot(estimate.error(), truth_error), truth);
    }
    void add(const std::string& what, double estimate, double error, double truth) {
        const double z = error > 0 ? (estimate - truth) / error : estimate == truth ? 0 : 1e9;
        items_.push_back({what, estimate, error, truth, z});
    }

    std::size_t count() const { return items_.size(); }
    double rms() const {
        double sum = 0;
        for (const Item& item : items_) sum += item.z * item.z;
        return std::sqrt(sum / static_cast<double>(items_.size()));
    }
    double mean() const {
        double sum = 0;
        for (const Item& item : items_) sum += item.z;
        return sum / static_cast<double>(items_.size());
    }

    /// At most one in a hundred, or one of fewer than a hundred if there are 20, lies beyond three
    /// standard errors, none beyond four. Prints those, and all if the environment asks for it.
    void expect_within_errors() const {
        const bool all = std::getenv("UWVDB_SHOW_DEVIATIONS") != nullptr;
        std::size_t beyond = 0;
        for (const Item& item : items_) {
            if (std::abs(item.z) > 3) ++beyond;
            EXPECT_LT(std::abs(item.z), 4) << describe(item);
            if (all || std::abs(item.z) > 3) std::cout << describe(item) << "\n";
        }
        const std::size_t allowed = count() < 20 ? 0 : std::max<std::size_t>(1, count() / 100);
        EXPECT_LE(beyond, allowed) << "of " << count();
        std::cout << count() << " estimates, deviations in stated errors: RMS " << rms()
                  << ", mean " << mean() << ", largest " << largest() << ", beyond three " << beyond
                  << "; largest relative deviation " << max_relative() << "\n";
    }
    /// Every standard error is below `fraction` of the truth, or that of every estimate whose
    /// name ends with `of`: being within errors says something.
    void expect_errors_below(double fraction, const std::string& of = "") const {
        for (const Item& item : items_)
            if (item.what.ends_with(of)) {
                EXPECT_LT(item.error, fraction * std::abs(item.truth)) << describe(item);
            }
    }
    /// Every estimate is within `fraction` of its truth.
    void expect_within(double fraction) const {
        for (const Item& item : items_)
            EXPECT_LT(std::abs(item.estimate / item.truth - 1), fraction) << describe(item);
    }

  private:
    struct Item {
        std::string what;
        double estimate, error, truth, z;
    };

    static std::string describe(const Item& item) {
        std::ostringstream text;
        text << item.what << ": " << item.estimate << " +- " << item.error << ", truth "
             << item.truth << " (" << 100 * (item.estimate / item.truth - 1) << " %, " << item.z
             << " errors)";
        return text.str();
    }
    double largest() const {
        double z = 0;
        for (const Item& item : items_) z = std::max(z, std::abs(item.z));
        return z;
    }
    double max_relative() const {
        double relative = 0;
        for (const Item& item : items_)
            relative = std::max(relative, std::abs(item.estimate / item.truth - 1));
        return relative;
    }

    std::vector<Item> items_;
};

}  // namespace uw::test
