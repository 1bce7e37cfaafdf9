#include "core/paths/node_smoothing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/base/available_memory.h"
#include "core/base/parallel.h"
#include "core/paths/lattice_fit.h"
#include "core/paths/multiple_nodes.h"

namespace uw {

namespace {

constexpr int k_variance_reach = 2;  // of nodes whose variances are averaged
static_assert(k_smoothing_reach == LatticeFit::k_reach + k_variance_reach);
// Differences between fits that do not matter, relative to the light of the nodes around.
constexpr double k_tolerance = 1e-3;
constexpr std::array<float, 2> k_sign_of_half{1, -1};

/// The nodes around one that take part in a fit.
class Neighbourhood {
  public:
    /// `of(index)` is a node's FitNode without its place, or empty if it takes no part.
    template <class Of>
    void find(const Grid2D<MultipleNode>& raw, int i, int j, const Of& of) {
        nodes_.clear();
        light_ = weight_ = 0;
        for (const auto& [dx, dy] : steps_by_distance()) {
            const int u = i + dx, v = j + dy;
            if (u < 0 || v < 0 || u >= raw.width() || v >= raw.height()) continue;
            const std::size_t index = raw.index(u, v);
            std::optional<FitNode> node = of(index);
            if (!node) continue;
            node->dx = dx;
            node->dy = dy;
            node->index = index;
            nodes_.push_back(*node);
            light_ += raw[index].mean_light;
            weight_ += node->weight;
        }
        const double count = std::max(1.0, static_cast<double>(nodes_.size()));
        light_ /= count;
        weight_ /= count;
    }

    std::span<const FitNode> nodes() const { return nodes_; }
    /// The mean of their light.
    double light() const { return light_; }
    /// The mean of their weights.
    double weight() const { return weight_; }

  private:
    struct Step {
        int dx, dy;
    };
    // Those that LatticeFit takes nodes from, the nearest first.
    static const std::vector<Step>& steps_by_distance() {
        static const std::vector<Step> steps = [] {
            constexpr int k_reach = LatticeFit::k_reach, k_beyond = (k_reach + 1) * (k_reach + 1);
            const auto square = [](const Step& step) {
                return step.dx * step.dx + step.dy * step.dy;
            };
            std::vector<Step> all;
            for (int dy = -k_reach; dy <= k_reach; ++dy)
                for (int dx = -k_reach; dx <= k_reach; ++dx)
                    if (square({dx, dy}) < k_beyond) all.push_back({dx, dy});
            std::ranges::stable_sort(all, std::less(), square);
            return all;
        }();
        return steps;
    }

    std::vector<FitNode> nodes_;
    double light_ = 0, weight_ = 0;
};

// The mean of what `of` finds in the nodes around each: the variance of a few batches says little
// by itself, and that of a whole neighbourhood would hide features of its dark parts.
template <class Of>
void average_around(const Grid2D<MultipleNode>& raw, std::size_t at, const Of& of) {
    constexpr int k_reach = k_variance_reach;
    const int i = static_cast<int>(at) % raw.width(), j = static_cast<int>(at) / raw.width();
    for (int v = std::max(0, j - k_reach); v <= std::min(raw.height() - 1, j + k_reach); ++v)
        for (int u = std::max(0, i - k_reach); u <= std::min(raw.width() - 1, i + k_reach); ++u)
            of(raw(u, v));
}

void average_surface_variances(const Grid2D<MultipleNode>& raw, Grid2D<MultipleNode>& nodes) {
    parallel_for(raw.size(), [&](std::size_t at) {
        double sum = 0, surfaces = 0;
        average_around(raw, at, [&](const MultipleNode& other) {
            if (!other.surface) return;
            ++surfaces;
            sum += other.surface_share * other.diffuse_variance;
        });
        nodes[at].diffuse_variance = sum / (std::max(surfaces, 1.0) * raw[at].surface_share);
    });
}

// The water's is in proportion to the weights of its intervals, as that of counts to their
// expectation, and inverse to the shares of paths.
void average_water_variances(const Grid2D<MultipleNode>& raw, Grid2D<MultipleNode>& nodes) {
    parallel_for(raw.size(), [&](std::size_t at) {
        std::vector<float>& of_node = nodes[at].water_variance;
        thread_local std::vector<double> variances, weights;
        variances.assign(of_node.size(), 0.0);
        weights.assign(of_node.size(), 0.0);
        average_around(raw, at, [&](const MultipleNode& other) {
            if (other.water_variance.empty()) return;
            for (std::size_t k = 0; k < variances.size(); ++k) {
                variances[k] += other.water_share * static_cast<double>(other.water_variance[k]);
                weights[k] += static_cast<double>(other.mean_weights[k]);
            }
        });
        for (std::size_t k = 0; k < of_node.size(); ++k)
            of_node[k] =
                weights[k] > 0
                    ? static_cast<float>(variances[k] / (weights[k] * raw[at].water_share) *
                                         static_cast<double>(nodes[at].mean_weights[k]))
                    : 0.0F;
    });
}

/// What the nodes tell of the water's light in one interval.
struct IntervalOfNodes {
    std::vector<float> weights;                 // 0: nothing
    std::array<std::vector<float>, 2> of_half;  // the light divided by that, by half
    std::vector<float> variances;               // of either

    IntervalOfNodes(const Grid2D<MultipleNode>& nodes, const DistanceIntervals& intervals,
                    std::size_t interval)
        : weights(nodes.size()), of_half{weights, weights}, variances(nodes.size()) {
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const MultipleNode& node = nodes[n];
            if (!shows_interval(node, intervals, interval)) continue;
            weights[n] = node.mean_weights[interval];
            for (const std::size_t half : {0U, 1U})
                of_half[half][n] = node.halves[half].water_mean[interval] / weights[n];
            variances[n] = node.water_variance[interval] / (weights[n] * weights[n]);
        }
    }
};

class NodeSmoothing {
  public:
    NodeSmoothing(const Grid2D<MultipleNode>& raw, std::size_t groups, std::size_t bands)
        : raw_(raw), bands_(bands), values_(groups * bands) {}

    /// Adds an interval to a node; false if none of the nodes around it tells anything.
    bool smooth_water(const IntervalOfNodes& of_nodes, std::size_t interval, int i, int j,
                      SmoothNode& node) const;
    void smooth_surface(int i, int j, SmoothNode& node) const;

  private:
    const Grid2D<MultipleNode>& raw_;
    std::size_t bands_, values_;
};

bool NodeSmoothing::smooth_water(const IntervalOfNodes& of_nodes, std::size_t interval, int i,
                                 int j, SmoothNode& node) const {
    thread_local LatticeFit fit;
    thread_local Neighbourhood near;
    const MultipleNode& own = raw_(i, j);
    for (std::size_t half = 0; half < 2; ++half) {
        near.find(raw_, i, j, [&](std::size_t other) -> std::optional<FitNode> {
            if (!(of_nodes.weights[other] > 0)) return std::nullopt;
            FitNode of;
            of.weight = static_cast<double>(of_nodes.weights[other]);
            of.value = static_cast<double>(of_nodes.of_half[1 - half][other]);
            of.variance = static_cast<double>(of_nodes.variances[other]);
            return of;
        });
        if (near.nodes().empty()) return false;
        // As much as the node's ray shows of it: nothing behind its surface.
        const double shown = own.has_ray ? static_cast<double>(own.mean_weights[interval]) : 0.0;
        const double tolerance = k_tolerance * near.light() / std::max(shown, 1e-3 * near.weight());
        for (const FitWeight& weight : fit.fit(near.nodes(), tolerance)) {
            const MultipleNode& other = raw_[weight.index];
            const float* water = &other.halves[half].water[interval * values_];
            for (std::size_t k = 0; k < values_; ++k) {
                const float of_band = other.weights[interval * bands_ + k % bands_];
                if (!(of_band > 0)) continue;
                const float light = static_cast<float>(0.5 * weight.weight) * water[k] / of_band;
                node.light.water[interval * values_ + k] += light;
                if (own.has_ray)
                    node.water_deviation[k % bands_] +=
                        k_sign_of_half[half] * light * own.weights[interval * bands_ + k % bands_];
            }
        }
    }
    return true;
}

void NodeSmoothing::smooth_surface(int i, int j, SmoothNode& node) const {
    thread_local LatticeFit fit;
    thread_local Neighbourhood near;
    const MultipleNode& own = raw_(i, j);
    node.surface = own.surface;
    node.light.diffuse.assign(values_, 0.0F);
    node.light.glossy.assign(own.surface->is_glossy ? values_ : 0, 0.0F);
    for (std::size_t half = 0; half < 2; ++half) {
        near.find(raw_, i, j, [&](std::size_t index) -> std::optional<FitNode> {
            const MultipleNode& other = raw_[index];
            if (!see_same_surface(own, other)) return std::nullopt;
            FitNode of;
            of.value = other.halves[1 - half].diffuse_mean;
            of.variance = other.diffuse_variance;
            return of;
        });
        const double tolerance = k_tolerance * near.light() / std::max(own.surface_seen, 1e-3);
        for (const FitWeight& weight : fit.fit(near.nodes(), tolerance)) {
            const NodeLight& other = raw_[weight.index].halves[half];
            const auto share = static_cast<float>(0.5 * weight.weight);
            for (std::size_t k = 0; k < values_; ++k) {
                node.light.diffuse[k] += share * other.diffuse[k];
                node.diffuse_deviation[k % bands_] +=
                    k_sign_of_half[half] * share * other.diffuse[k];
            }
            for (std::size_t k = 0; k < node.light.glossy.size(); ++k)
                node.light.glossy[k] += share * other.glossy[k];
        }
    }
}

}  // namespace

// Nodes as they were estimated, with their variances averaged, and smoothed.
void require_room_for_nodes(std::size_t nodes, std::size_t intervals, std::size_t groups,
                            const LitScene& scene) {
    const auto bands = static_cast<std::size_t>(scene.medium->band_count());
    const std::size_t copies = 2 * (1 + 2 * groups) + groups;
    const double bytes = static_cast<double>(sizeof(float) * copies) *
                         static_cast<double>(nodes * intervals * bands);
    require_memory(bytes,
                   fmt::format("render.scattering: multiple: {} lamps in {} bands need",
                               scene.lamp_count(), bands),
                   "leave out the lamps' layers, use fewer bands, or --quality draft");
}

Grid2D<SmoothNode> smoothed_surfaces(const Grid2D<MultipleNode>& raw, std::size_t groups,
                                     std::size_t bands) {
    Grid2D<SmoothNode> nodes;
    nodes.assign(raw.width(), raw.height());
    Grid2D<MultipleNode> averaged = raw;
    average_surface_variances(raw, averaged);
    const NodeSmoothing smoothing(averaged, groups, bands);
    parallel_for(raw.size(), [&](std::size_t at) {
        if (!raw[at].surface) return;
        nodes[at].diffuse_deviation.assign(bands, 0.0F);
        smoothing.smooth_surface(static_cast<int>(at) % raw.width(),
                                 static_cast<int>(at) / raw.width(), nodes[at]);
    });
    return nodes;
}

void smooth_water(const Grid2D<MultipleNode>& raw, const NodeWindow& window,
                  const DistanceIntervals& intervals, std::size_t groups, std::size_t bands,
                  Grid2D<SmoothNode>& nodes) {
    Grid2D<MultipleNode> averaged = raw;
    average_water_variances(raw, averaged);
    const NodeSmoothing smoothing(averaged, groups, bands);
    const int columns = window.i1 - window.i0;
    const auto for_each = [&](const auto& visit) {
        parallel_for(window.size(), [&](std::size_t at) {
            visit(window.i0 + static_cast<int>(at) % columns,
                  window.j0 + static_cast<int>(at) / columns);
        });
    };
    for_each([&](int i, int j) {
        nodes(i, j).light.water.assign(intervals.count() * groups * bands, 0.0F);
        nodes(i, j).water_deviation.assign(bands, 0.0F);
        nodes(i, j).mean_light = raw(i, j).mean_light;
    });
    for (std::size_t interval = 0; interval < intervals.count(); ++interval) {
        const IntervalOfNodes of_nodes(averaged, intervals, interval);
        // Nothing is known of what lies behind an interval that no node tells of.
        const double before = interval == 0 ? 0 : intervals.end(interval - 1);
        for_each([&](int i, int j) {
            SmoothNode& node = nodes(i, j);
            if (node.known_to == before && smoothing.smooth_water(of_nodes, interval, i, j, node))
                node.known_to = intervals.end(interval);
        });
    }
}

}  // namespace uw
