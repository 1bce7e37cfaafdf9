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
#include "core/paths/radiance_nodes.h"

namespace uw {

namespace {

// Differences between fits that do not matter, relative to the light of the nodes around.
constexpr double k_tolerance = 1e-3;
// The variance of the mean of both halves per squared weight in either and per squared difference
// of the halves, whose expectation is twice the variance of either.
constexpr double k_variance_of_mean = 0.125;

/// The nodes around a node that take part in its fit.
class Neighbourhood {
  public:
    /// `of(index)` returns a node's FitNode without its offset, or nullopt if it takes no part.
    template <class Of>
    void find(const Grid2D<RadianceNode>& raw, int i, int j, const Of& of) {
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
    /// The mean light of the nodes.
    double light() const { return light_; }
    /// The mean weight of the nodes.
    double weight() const { return weight_; }

  private:
    struct Step {
        int dx, dy;
    };
    // The offsets within LatticeFit's radius, the nearest first.
    static const std::vector<Step>& steps_by_distance() {
        static const std::vector<Step> steps = [] {
            constexpr int k_max_radius = LatticeFit::k_max_radius,
                          k_beyond = (k_max_radius + 1) * (k_max_radius + 1);
            const auto square = [](const Step& step) {
                return step.dx * step.dx + step.dy * step.dy;
            };
            std::vector<Step> all;
            for (int dy = -k_max_radius; dy <= k_max_radius; ++dy)
                for (int dx = -k_max_radius; dx <= k_max_radius; ++dx)
                    if (square({dx, dy}) < k_beyond) all.push_back({dx, dy});
            std::ranges::stable_sort(all, std::less(), square);
            return all;
        }();
        return steps;
    }

    std::vector<FitNode> nodes_;
    double light_ = 0, weight_ = 0;
};

// Visits the nodes around one, to average their variances: that of a few batches is noisy, and that
// of a whole neighbourhood would hide features of its dark parts.
template <class Of>
void average_around(const Grid2D<RadianceNode>& raw, std::size_t at, const Of& of) {
    constexpr int k_radius = k_variance_radius;
    const int i = static_cast<int>(at) % raw.width(), j = static_cast<int>(at) / raw.width();
    for (int v = std::max(0, j - k_radius); v <= std::min(raw.height() - 1, j + k_radius); ++v)
        for (int u = std::max(0, i - k_radius); u <= std::min(raw.width() - 1, i + k_radius); ++u)
            of(raw(u, v));
}

void average_surface_variances(const Grid2D<RadianceNode>& raw, Grid2D<RadianceNode>& nodes) {
    parallel_for(raw.size(), [&](std::size_t at) {
        for (const std::size_t half : {0U, 1U}) {
            double sum = 0, surfaces = 0;
            average_around(raw, at, [&](const RadianceNode& other) {
                if (!other.surface) return;
                ++surfaces;
                sum += other.surface_scale * other.halves[half].diffuse_variance;
            });
            nodes[at].halves[half].diffuse_variance =
                sum / (std::max(surfaces, 1.0) * raw[at].surface_scale);
        }
    });
}

// The variance of the water's light is assumed in proportion to the weights of its intervals, as
// that of Poisson counts to their expectation, and inverse to the numbers of paths.
void average_water_variances(const Grid2D<RadianceNode>& raw, Grid2D<RadianceNode>& nodes) {
    parallel_for(raw.size(), [&](std::size_t at) {
        for (const std::size_t half : {0U, 1U}) {
            std::vector<float>& of_node = nodes[at].halves[half].water_variance;
            std::vector<double> variances(of_node.size(), 0.0), weights(of_node.size(), 0.0);
            average_around(raw, at, [&](const RadianceNode& other) {
                const std::vector<float>& of_other = other.halves[half].water_variance;
                if (of_other.empty()) return;
                for (std::size_t k = 0; k < variances.size(); ++k) {
                    variances[k] += other.water_scale * static_cast<double>(of_other[k]);
                    weights[k] += static_cast<double>(other.mean_weights[k]);
                }
            });
            for (std::size_t k = 0; k < of_node.size(); ++k)
                of_node[k] =
                    weights[k] > 0
                        ? static_cast<float>(variances[k] / (weights[k] * raw[at].water_scale) *
                                             static_cast<double>(nodes[at].mean_weights[k]))
                        : 0.0F;
        }
    });
}

// Adds the squared differences between the halves, by band, summed over the groups.
void add_squares(std::span<const float> a, std::span<const float> b, std::span<float> squares) {
    for (std::size_t band = 0; band < squares.size(); ++band) {
        float difference = 0;
        for (std::size_t k = band; k < a.size(); k += squares.size()) difference += a[k] - b[k];
        squares[band] += difference * difference;
    }
}

/// The light of the water in one interval, at all nodes.
struct IntervalOfNodes {
    std::vector<NodeReach> reach;
    std::vector<float> weights;  // 0: the node's ray scatters no light there
    // By half of the estimates: the light divided by the weight, and its variance.
    std::array<std::vector<float>, 2> of_half, variances;
    std::vector<float> squares;  // of the halves' difference over the weight, by band

    IntervalOfNodes(const Grid2D<RadianceNode>& nodes, const DistanceIntervals& intervals,
                    std::size_t interval, std::size_t groups, std::size_t bands)
        : reach(nodes.size()),
          weights(nodes.size()),
          of_half{weights, weights},
          variances{weights, weights},
          squares(nodes.size() * bands) {
        // Smaller weights are lost to the precision of float.
        constexpr float k_min_weight = 1e-30F;
        const std::size_t values = groups * bands;
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const RadianceNode& node = nodes[n];
            reach[n] = reach_into(node, intervals, interval);
            if (reach[n] == NodeReach::none || !(node.mean_weights[interval] >= k_min_weight))
                continue;
            weights[n] = node.mean_weights[interval];
            for (const std::size_t half : {0U, 1U}) {
                of_half[half][n] = node.halves[half].water_mean[interval] / weights[n];
                variances[half][n] =
                    node.halves[half].water_variance[interval] / (weights[n] * weights[n]);
            }
            const auto light = [&](std::size_t half) {
                return std::span(node.halves[half].water).subspan(interval * values, values);
            };
            const std::span<float> own = std::span(squares).subspan(n * bands, bands);
            add_squares(light(0), light(1), own);
            for (std::size_t b = 0; b < bands; ++b) {
                const float weight = node.weights[interval * bands + b];
                own[b] = weight > 0 ? own[b] / weight / weight : 0;
            }
        }
    }
};

/// The radii of the neighbourhoods chosen at the nodes of a lattice; -1: none.
using Radii = Grid2D<signed char>;

/// The narrowest neighbourhood of a node that others bear out: its own, or the k_support-th
/// narrowest of the eight nodes around that `belong(index)`. A feature is seen by neighbours, too;
/// what stops the smoothing at single nodes is noise, which would stand as a spot.
template <class Belong>
int supported_radius(const Radii& radii, int i, int j, const Belong& belong) {
    constexpr std::size_t k_support = 4;  // fewer leave spots, more blur lamps
    std::array<int, 8> around{};
    std::size_t count = 0;
    for (int v = std::max(0, j - 1); v <= std::min(radii.height() - 1, j + 1); ++v)
        for (int u = std::max(0, i - 1); u <= std::min(radii.width() - 1, i + 1); ++u)
            if ((u != i || v != j) && radii(u, v) >= 0 && belong(radii.index(u, v)))
                around[count++] = radii(u, v);
    const int own = radii(i, j);
    if (count < k_support) return own;
    std::ranges::nth_element(around.begin(), around.begin() + k_support - 1,
                             around.begin() + static_cast<std::ptrdiff_t>(count));
    return std::max(own, around[k_support - 1]);
}

class NodeSmoothing {
  public:
    NodeSmoothing(const Grid2D<RadianceNode>& raw, std::size_t groups, std::size_t bands)
        : raw_(raw), bands_(bands), values_(groups * bands) {}

    /// The radii that the nodes' values ask for: the wider of those of both halves, since a feature
    /// that only one half sees is noise. -1: no node around has light there.
    int water_radius(const IntervalOfNodes& of_nodes, std::size_t interval, int i, int j) const;
    int surface_radius(int i, int j) const;
    /// Smooths an interval of a node; returns false if no node around it reaches that far.
    bool smooth_water(const IntervalOfNodes& of_nodes, std::size_t interval, int i, int j,
                      const Radii& radii, SmoothNode& node) const;
    void smooth_surface(int i, int j, const Radii& radii, SmoothNode& node) const;

  private:
    // Finds the nodes that take part, with the values of one half; returns whether any node reaches
    // as far.
    bool find_water(const IntervalOfNodes& of_nodes, int i, int j, std::size_t half,
                    Neighbourhood& near) const;
    void find_surface(int i, int j, std::size_t half, Neighbourhood& near) const;

    const Grid2D<RadianceNode>& raw_;
    std::size_t bands_, values_;
};

bool NodeSmoothing::find_water(const IntervalOfNodes& of_nodes, int i, int j, std::size_t half,
                               Neighbourhood& near) const {
    bool is_reached = false;
    const auto find = [&](NodeReach min_reach) {
        near.find(raw_, i, j, [&](std::size_t other) -> std::optional<FitNode> {
            if (of_nodes.reach[other] < min_reach) return std::nullopt;
            is_reached = true;
            if (!(of_nodes.weights[other] > 0)) return std::nullopt;
            FitNode of;
            of.weight = static_cast<double>(of_nodes.weights[other]);
            of.value = static_cast<double>(of_nodes.of_half[half][other]);
            of.variance = static_cast<double>(of_nodes.variances[half][other]);
            return of;
        });
    };
    find(NodeReach::enough);
    if (near.nodes().empty()) find(NodeReach::little);
    return is_reached;
}

int NodeSmoothing::water_radius(const IntervalOfNodes& of_nodes, std::size_t interval, int i,
                                int j) const {
    LatticeFit fit;
    Neighbourhood near;
    const RadianceNode& own = raw_(i, j);
    int radius = -1;
    for (const std::size_t half : {0U, 1U}) {
        find_water(of_nodes, i, j, half, near);
        // Weighted as on the node's ray, which shows nothing behind its surface.
        const double visible_weight =
            own.has_ray ? static_cast<double>(own.mean_weights[interval]) : 0.0;
        const double tolerance =
            k_tolerance * near.light() / std::max(visible_weight, 1e-3 * near.weight());
        fit.fit(near.nodes(), tolerance);
        radius = std::max(radius, fit.radius());
    }
    return radius;
}

bool NodeSmoothing::smooth_water(const IntervalOfNodes& of_nodes, std::size_t interval, int i,
                                 int j, const Radii& radii, SmoothNode& node) const {
    LatticeFit fit;
    Neighbourhood near;
    const RadianceNode& own = raw_(i, j);
    // The same for both halves: weights depend on where nodes are, not on their values.
    const bool is_reached = find_water(of_nodes, i, j, 0, near);
    // Water that scatters nothing is known to be dark.
    if (near.nodes().empty()) return is_reached;
    fit.fit_within(near.nodes(), supported_radius(radii, i, j, [](std::size_t) { return true; }));
    for (const std::size_t half : {0U, 1U}) {
        for (const FitWeight& weight : fit.weights()) {
            const RadianceNode& other = raw_[weight.index];
            const float* water = &other.halves[half].water[interval * values_];
            for (std::size_t k = 0; k < values_; ++k) {
                const float of_band = other.weights[interval * bands_ + k % bands_];
                if (of_band > 0)
                    node.light.water[interval * values_ + k] +=
                        static_cast<float>(0.5 * weight.weight) * water[k] / of_band;
            }
            if (!own.has_ray) continue;
            const auto square =
                static_cast<float>(k_variance_of_mean * weight.weight * weight.weight);
            for (std::size_t b = 0; b < bands_; ++b) {
                const float of_band = own.weights[interval * bands_ + b];
                node.water_variance[b] +=
                    square * of_nodes.squares[weight.index * bands_ + b] * of_band * of_band;
            }
        }
        if (!own.has_ray || fit.narrower().empty()) continue;
        const auto add_shift = [&](std::span<const FitWeight> weights_of_fit, float sign) {
            for (const FitWeight& weight : weights_of_fit) {
                const RadianceNode& other = raw_[weight.index];
                const float* water = &other.halves[half].water[interval * values_];
                for (std::size_t k = 0; k < values_; ++k) {
                    const std::size_t b = interval * bands_ + k % bands_;
                    if (other.weights[b] > 0)
                        node.water_shift[half][k % bands_] +=
                            sign * static_cast<float>(weight.weight) * water[k] / other.weights[b] *
                            own.weights[b];
                }
            }
        };
        add_shift(fit.weights(), 1);
        add_shift(fit.narrower(), -1);
    }
    return true;
}

void NodeSmoothing::find_surface(int i, int j, std::size_t half, Neighbourhood& near) const {
    near.find(raw_, i, j, [&](std::size_t index) -> std::optional<FitNode> {
        const RadianceNode& other = raw_[index];
        if (!see_same_surface(raw_(i, j), other)) return std::nullopt;
        FitNode of;
        of.value = other.halves[half].diffuse_mean;
        of.variance = other.halves[half].diffuse_variance;
        return of;
    });
}

int NodeSmoothing::surface_radius(int i, int j) const {
    LatticeFit fit;
    Neighbourhood near;
    int radius = -1;
    for (const std::size_t half : {0U, 1U}) {
        find_surface(i, j, half, near);
        fit.fit(near.nodes(),
                k_tolerance * near.light() / std::max(raw_(i, j).surface_throughput, 1e-3));
        radius = std::max(radius, fit.radius());
    }
    return radius;
}

void NodeSmoothing::smooth_surface(int i, int j, const Radii& radii, SmoothNode& node) const {
    LatticeFit fit;
    Neighbourhood near;
    std::vector<float> squares;
    const RadianceNode& own = raw_(i, j);
    find_surface(i, j, 0, near);
    fit.fit_within(near.nodes(), supported_radius(radii, i, j, [&](std::size_t other) {
                       return see_same_surface(own, raw_[other]);
                   }));
    node.surface = own.surface;
    const auto begin = [&](bool is_there, std::vector<float>& light, std::vector<float>& variance) {
        light.assign(is_there ? values_ : 0, 0.0F);
        variance.assign(is_there ? bands_ : 0, 0.0F);
    };
    begin(true, node.light.diffuse, node.diffuse_variance);
    begin(own.surface->is_glossy, node.light.glossy, node.glossy_variance);
    for (const std::size_t half : {0U, 1U}) {
        for (const FitWeight& weight : fit.weights()) {
            const RadianceNode& other = raw_[weight.index];
            const auto add = [&](const std::vector<float> NodeRadiance::*values,
                                 std::vector<float>& light, std::vector<float>& variance) {
                const std::vector<float>& of_half = other.halves[half].*values;
                for (std::size_t k = 0; k < light.size(); ++k)
                    light[k] += static_cast<float>(0.5 * weight.weight) * of_half[k];
                squares.assign(variance.size(), 0.0F);
                if (!light.empty()) add_squares(of_half, other.halves[1 - half].*values, squares);
                for (std::size_t b = 0; b < variance.size(); ++b)
                    variance[b] +=
                        static_cast<float>(k_variance_of_mean * weight.weight * weight.weight) *
                        squares[b];
            };
            add(&NodeRadiance::diffuse, node.light.diffuse, node.diffuse_variance);
            add(&NodeRadiance::glossy, node.light.glossy, node.glossy_variance);
        }
        node.diffuse_shift[half].assign(bands_, 0.0F);
        if (fit.narrower().empty()) continue;
        const auto add_shift = [&](std::span<const FitWeight> weights_of_fit, float sign) {
            for (const FitWeight& weight : weights_of_fit)
                for (std::size_t k = 0; k < values_; ++k)
                    node.diffuse_shift[half][k % bands_] +=
                        sign * static_cast<float>(weight.weight) *
                        raw_[weight.index].halves[half].diffuse[k];
        };
        add_shift(fit.weights(), 1);
        add_shift(fit.narrower(), -1);
    }
}

}  // namespace

// Counts the nodes as estimated, a copy with averaged variances, and the smoothed nodes.
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

Grid2D<SmoothNode> smoothed_surfaces(const Grid2D<RadianceNode>& raw, std::size_t groups,
                                     std::size_t bands) {
    Grid2D<SmoothNode> nodes;
    nodes.assign(raw.width(), raw.height());
    Grid2D<RadianceNode> averaged = raw;
    average_surface_variances(raw, averaged);
    const NodeSmoothing smoothing(averaged, groups, bands);
    const auto for_each = [&](const auto& visit) {
        parallel_for(raw.size(), [&](std::size_t at) {
            if (raw[at].surface)
                visit(static_cast<int>(at) % raw.width(), static_cast<int>(at) / raw.width());
        });
    };
    Radii radii;
    radii.assign(raw.width(), raw.height(), -1);
    for_each([&](int i, int j) {
        radii(i, j) = static_cast<signed char>(smoothing.surface_radius(i, j));
    });
    for_each([&](int i, int j) { smoothing.smooth_surface(i, j, radii, nodes(i, j)); });
    return nodes;
}

void smooth_water(const Grid2D<RadianceNode>& raw, const NodeWindow& window,
                  const DistanceIntervals& intervals, std::size_t groups, std::size_t bands,
                  Grid2D<SmoothNode>& nodes) {
    Grid2D<RadianceNode> averaged = raw;
    average_water_variances(raw, averaged);
    const NodeSmoothing smoothing(averaged, groups, bands);
    const auto for_each = [&](const NodeWindow& within, const auto& visit) {
        const int columns = within.i1 - within.i0;
        parallel_for(within.size(), [&](std::size_t at) {
            visit(within.i0 + static_cast<int>(at) % columns,
                  within.j0 + static_cast<int>(at) / columns);
        });
    };
    const NodeWindow around{std::max(0, window.i0 - 1), std::max(0, window.j0 - 1),
                            std::min(raw.width(), window.i1 + 1),
                            std::min(raw.height(), window.j1 + 1)};
    Radii radii;
    radii.assign(raw.width(), raw.height(), -1);
    for_each(window, [&](int i, int j) {
        nodes(i, j).light.water.assign(intervals.count() * groups * bands, 0.0F);
        nodes(i, j).water_variance.assign(bands, 0.0F);
        for (std::vector<float>& shift : nodes(i, j).water_shift) shift.assign(bands, 0.0F);
    });
    for (std::size_t interval = 0; interval < intervals.count(); ++interval) {
        const IntervalOfNodes of_nodes(averaged, intervals, interval, groups, bands);
        // What lies behind an interval that no node reaches is unknown.
        const double before = interval == 0 ? 0 : intervals.end(interval - 1);
        for_each(around, [&](int i, int j) {
            radii(i, j) =
                static_cast<signed char>(smoothing.water_radius(of_nodes, interval, i, j));
        });
        for_each(window, [&](int i, int j) {
            SmoothNode& node = nodes(i, j);
            if (node.known_to == before &&
                smoothing.smooth_water(of_nodes, interval, i, j, radii, node))
                node.known_to = intervals.end(interval);
        });
    }
}

}  // namespace uw
