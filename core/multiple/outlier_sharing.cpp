#include "core/multiple/outlier_sharing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/multiple/node_kinship.h"

namespace uw {

namespace {

// Nodes that say what to expect, and those that what is too much is shared among, in steps.
constexpr int k_expecting_reach = 2, k_taking_reach = 4;
static_assert(k_expecting_reach + k_taking_reach == k_sharing_reach);
// A half is limited to so many standard deviations above the nodes around, or to so many times the
// other half.
constexpr double k_most_deviations = 4, k_most_of_other_half = 1.5;
constexpr std::size_t k_fewest_values = 8;  // that say what to expect

/// Light of one kind that nodes hold, in values that are alike from node to node.
class NodeQuantity {
  public:
    virtual ~NodeQuantity() = default;
    /// Whether node `other` says something about `node`, which may be the same.
    virtual bool is_alike(const MultipleNode& node, const MultipleNode& other) const = 0;
    virtual double value(const MultipleNode& node, std::size_t half) const = 0;
    /// The light itself by group and band, and what an even value of 1 is of it, by band.
    virtual std::span<float> light(NodeLight& half) const = 0;
    virtual double of_even_value(const MultipleNode& node, std::size_t band) const = 0;
    /// The mean over the bands, to which `change` is added.
    virtual void add_to_mean(NodeLight& half, double change) const = 0;
};

class WaterQuantity final : public NodeQuantity {
  public:
    WaterQuantity(const DistanceIntervals& intervals, std::size_t interval, std::size_t groups,
                  std::size_t bands)
        : intervals_(intervals), interval_(interval), values_(groups * bands), bands_(bands) {}

    bool is_alike(const MultipleNode& node, const MultipleNode& other) const override {
        return shows_interval(node, intervals_, interval_) &&
               shows_interval(other, intervals_, interval_);
    }
    double value(const MultipleNode& node, std::size_t half) const override {
        return static_cast<double>(node.halves[half].water_mean[interval_]) /
               static_cast<double>(node.mean_weights[interval_]);
    }
    std::span<float> light(NodeLight& half) const override {
        return std::span(half.water).subspan(interval_ * values_, values_);
    }
    double of_even_value(const MultipleNode& node, std::size_t band) const override {
        return static_cast<double>(node.weights[interval_ * bands_ + band]);
    }
    void add_to_mean(NodeLight& half, double change) const override {
        half.water_mean[interval_] += static_cast<float>(change);
    }

  private:
    const DistanceIntervals& intervals_;
    std::size_t interval_, values_, bands_;
};

class SurfaceQuantity final : public NodeQuantity {
  public:
    bool is_alike(const MultipleNode& node, const MultipleNode& other) const override {
        return see_same_surface(node, other);
    }
    double value(const MultipleNode& node, std::size_t half) const override {
        return node.halves[half].diffuse_mean;
    }
    std::span<float> light(NodeLight& half) const override { return half.diffuse; }
    double of_even_value(const MultipleNode&, std::size_t) const override { return 1; }
    void add_to_mean(NodeLight& half, double change) const override { half.diffuse_mean += change; }
};

/// Calls `visit` with each node within `reach` that is alike.
template <class Visit>
void for_alike(const NodeQuantity& quantity, const Grid2D<MultipleNode>& nodes, std::size_t at,
               int reach, const Visit& visit) {
    const int i = static_cast<int>(at) % nodes.width(), j = static_cast<int>(at) / nodes.width();
    for (int v = std::max(0, j - reach); v <= std::min(nodes.height() - 1, j + reach); ++v)
        for (int u = std::max(0, i - reach); u <= std::min(nodes.width() - 1, i + reach); ++u)
            if (quantity.is_alike(nodes[at], nodes(u, v))) visit(nodes.index(u, v));
}

// The most that a half of a node may hold, as a value; infinity if too little is known. By median
// and median deviation, which other outliers among the nodes around hardly move.
double limit_of(const NodeQuantity& quantity, const Grid2D<MultipleNode>& nodes, std::size_t at,
                std::size_t half) {
    constexpr double k_deviation_of_median = 1.4826;  // of a normal distribution
    thread_local std::vector<double> values;
    values.clear();
    for_alike(quantity, nodes, at, k_expecting_reach, [&](std::size_t other) {
        if (other == at) return;
        for (const std::size_t h : {0U, 1U}) values.push_back(quantity.value(nodes[other], h));
    });
    if (values.size() < k_fewest_values) return std::numeric_limits<double>::infinity();
    const auto median_of_values = [] {
        const auto middle = values.begin() + std::ssize(values) / 2;
        std::ranges::nth_element(values, middle);
        return *middle;
    };
    const double median = median_of_values();
    for (double& value : values) value = std::abs(value - median);
    const double deviation = k_deviation_of_median * median_of_values();
    return std::max({0.0, median + k_most_deviations * deviation,
                     k_most_of_other_half * quantity.value(nodes[at], 1 - half)});
}

void share(const NodeQuantity& quantity, std::size_t bands, Grid2D<MultipleNode>& nodes) {
    // Of the light of each half.
    std::vector<std::array<double, 2>> kept(nodes.size(), {1, 1});
    parallel_for(nodes.size(), [&](std::size_t at) {
        if (!quantity.is_alike(nodes[at], nodes[at])) return;
        for (const std::size_t half : {0U, 1U}) {
            const double value = quantity.value(nodes[at], half);
            if (!(value > 0)) continue;
            const double limit = limit_of(quantity, nodes, at, half);
            if (value > limit) kept[at][half] = limit / value;
        }
    });
    std::vector<double> excess, even;
    for (std::size_t at = 0; at < nodes.size(); ++at) {
        for (const std::size_t half : {0U, 1U}) {
            if (kept[at][half] == 1) continue;
            const std::span<float> light = quantity.light(nodes[at].halves[half]);
            excess.assign(light.begin(), light.end());
            for (double& value : excess) value *= 1 - kept[at][half];
            even.assign(bands, 0.0);
            for_alike(quantity, nodes, at, k_taking_reach, [&](std::size_t other) {
                for (std::size_t b = 0; b < bands; ++b)
                    even[b] += quantity.of_even_value(nodes[other], b);
            });
            const auto add = [&](std::size_t other, const auto& change_of) {
                NodeLight& to = nodes[other].halves[half];
                const std::span<float> values = quantity.light(to);
                double sum = 0;
                for (std::size_t k = 0; k < values.size(); ++k) {
                    const double change = change_of(k);
                    values[k] += static_cast<float>(change);
                    sum += change;
                }
                quantity.add_to_mean(to, sum / static_cast<double>(bands));
            };
            add(at, [&](std::size_t k) { return -excess[k]; });
            for_alike(quantity, nodes, at, k_taking_reach, [&](std::size_t other) {
                add(other, [&](std::size_t k) {
                    const double all = even[k % bands];
                    const double share = quantity.of_even_value(nodes[other], k % bands);
                    return all > 0 ? excess[k] * share / all : other == at ? excess[k] : 0.0;
                });
            });
        }
    }
}

}  // namespace

void share_outliers(Grid2D<MultipleNode>& nodes, const DistanceIntervals& intervals,
                    std::size_t groups) {
    std::size_t values = 0;
    for (const MultipleNode& node : nodes) values = std::max(values, node.halves[0].water.size());
    if (values == 0) return;
    const std::size_t bands = values / (intervals.count() * groups);
    for (std::size_t interval = 0; interval < intervals.count(); ++interval)
        share(WaterQuantity(intervals, interval, groups, bands), bands, nodes);
    share(SurfaceQuantity(), bands, nodes);
}

}  // namespace uw
