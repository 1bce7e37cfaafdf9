#include "core/paths/node_smoothing.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "core/base/available_memory.h"
#include "core/base/parallel.h"

namespace uw {

namespace {

// The variance of the mean of both halves, per sum of theirs, and per squared difference.
constexpr double k_variance_of_mean = 0.25;

// The sum of the variances of both halves of the light on a node's surface: of what is diffuse by
// their batches, of what is glossy by how much they differ.
double variances_of_diffuse(const RadianceNode& node) {
    return node.halves[0].diffuse_variance + node.halves[1].diffuse_variance;
}
double variances_of_glossy(const RadianceNode& node) {
    double difference = 0;
    const std::size_t bands = node.surface_throughput_by_band.size();
    const std::vector<float>&a = node.halves[0].glossy, &b = node.halves[1].glossy;
    for (std::size_t k = 0; k < a.size(); ++k)
        difference += static_cast<double>(a[k] - b[k]) / static_cast<double>(bands);
    return difference * difference;
}

// The variance of a node's light on its surface, the mean of both halves, as those around have it.
template <class Variances>
float variance_of_surface(const Grid2D<RadianceNode>& nodes, int i, int j,
                          const Variances& variances) {
    double sum = 0, surfaces = 0;
    visit_around(nodes, i, j, k_variance_radius, [&](const RadianceNode& other) {
        if (!other.surface) return;
        ++surfaces;
        sum += other.surface_scale * variances(other);
    });
    return static_cast<float>(k_variance_of_mean * sum /
                              (std::max(surfaces, 1.0) * nodes(i, j).surface_scale));
}

// The variances of the water's light, over the weights of its intervals. That light is assumed to
// vary in proportion to the weights, as Poisson counts to their expectation, and inverse to the
// numbers of paths.
std::vector<float> variances_of_water(const Grid2D<RadianceNode>& nodes, int i, int j) {
    const RadianceNode& own = nodes(i, j);
    const std::size_t intervals = own.mean_weights.size();
    std::vector<double> variances(intervals, 0.0), weights(intervals, 0.0);
    visit_around(nodes, i, j, k_variance_radius, [&](const RadianceNode& other) {
        if (other.mean_weights.empty()) return;
        for (std::size_t k = 0; k < intervals; ++k) {
            for (const NodeRadiance& half : other.halves)
                variances[k] += other.water_scale * static_cast<double>(half.water_variance[k]);
            weights[k] += static_cast<double>(other.mean_weights[k]);
        }
    });
    std::vector<float> of_node(intervals, 0.0F);
    for (std::size_t k = 0; k < intervals; ++k) {
        const double both = weights[k] * own.water_scale * static_cast<double>(own.mean_weights[k]);
        if (both > 0) of_node[k] = static_cast<float>(k_variance_of_mean * variances[k] / both);
    }
    return of_node;
}

std::vector<float> part_of(const std::vector<float>& all, std::size_t index, std::size_t count) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(index * count);
    return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

// The light of the water in one interval, per weight.
LatticeLight light_of_interval(const Grid2D<RadianceNode>& raw, std::size_t interval,
                               const std::vector<NodeReach>& reach,
                               const std::vector<std::vector<float>>& variances, std::size_t groups,
                               std::size_t bands) {
    // Smaller weights are lost to the precision of float.
    constexpr float k_min_weight = 1e-30F;
    LatticeLight light(raw.width(), raw.height(), groups * bands, bands);
    for (std::size_t n = 0; n < raw.size(); ++n) {
        const RadianceNode& node = raw[n];
        if (reach[n] == NodeReach::none || !(node.mean_weights[interval] >= k_min_weight)) continue;
        light.weights[n] = static_cast<double>(node.mean_weights[interval]);
        light.brightness[n] = node.mean_light;
        light.variances[n] = variances[n][interval];
        for (std::size_t b = 0; b < bands; ++b) {
            const float weight = node.weights[interval * bands + b];
            light.band_weights[n * bands + b] = weight / node.mean_weights[interval];
            if (!(weight > 0)) continue;
            for (const std::size_t half : {0U, 1U})
                for (std::size_t v = b; v < light.values; v += bands)
                    light.of_node(half, n)[v] =
                        node.halves[half].water[interval * light.values + v] / weight;
        }
    }
    return light;
}

// Whether any node around reaches an interval, and be it that none of them has water there.
bool is_reached(const Grid2D<RadianceNode>& nodes, const DistanceIntervals& intervals,
                std::size_t interval, int i, int j) {
    bool is_any = false;
    visit_around(nodes, i, j, k_max_neighbourhood, [&](const RadianceNode& node) {
        is_any = is_any || reach_into(node, intervals, interval) != NodeReach::none;
    });
    return is_any;
}

}  // namespace

// Counts the nodes as estimated, the smoothed nodes, and what the smoothing of an interval takes.
void require_room_for_nodes(std::size_t nodes, std::size_t intervals, std::size_t groups,
                            const LitScene& scene) {
    const auto bands = static_cast<std::size_t>(scene.medium->band_count());
    constexpr std::size_t k_copies_of_interval = 16;
    const std::size_t copies = (2 + 3 * groups) * intervals + k_copies_of_interval * groups;
    const double bytes =
        static_cast<double>(sizeof(float) * copies) * static_cast<double>(nodes * bands);
    require_memory(bytes,
                   fmt::format("render.scattering: multiple: {} lamps in {} bands need",
                               scene.lamp_count(), bands),
                   "leave out the lamps' layers, use fewer bands, or --quality draft");
}

Grid2D<SmoothNode> smoothed_surfaces(const Grid2D<RadianceNode>& raw, std::size_t groups,
                                     std::size_t bands) {
    Grid2D<SmoothNode> nodes(raw.width(), raw.height());
    const auto is_same = [&](std::size_t own, std::size_t other) {
        return see_same_surface(raw[own], raw[other]);
    };
    // `has_light(surface)`: whether it has this kind of light.
    const auto smooth_light = [&](const std::vector<float> NodeRadiance::*of_half,
                                  const auto& variances, const auto& has_light, const auto& store) {
        LatticeLight light(raw.width(), raw.height(), groups * bands, bands);
        for (int j = 0; j < raw.height(); ++j)
            for (int i = 0; i < raw.width(); ++i) {
                const std::size_t n = raw.index(i, j);
                if (!raw[n].surface || !has_light(*raw[n].surface)) continue;
                light.weights[n] = 1;
                light.brightness[n] = raw[n].mean_light;
                light.variances[n] = variance_of_surface(raw, i, j, variances);
                for (const std::size_t half : {0U, 1U})
                    std::ranges::copy(raw[n].halves[half].*of_half, light.of_node(half, n).begin());
            }
        const SmoothedLight smoothed = smooth(
            light, {0, 0, raw.width(), raw.height()},
            [&](std::size_t own, std::size_t other, bool) { return is_same(own, other); }, is_same);
        for (std::size_t n = 0; n < raw.size(); ++n)
            if (light.weights[n] > 0)
                store(nodes[n], part_of(smoothed.light, n, light.values),
                      part_of(smoothed.variances, n, bands),
                      std::array{part_of(smoothed.shifts[0], n, bands),
                                 part_of(smoothed.shifts[1], n, bands)});
    };
    smooth_light(
        &NodeRadiance::diffuse, variances_of_diffuse, [](const NodeSurface&) { return true; },
        [](SmoothNode& node, auto&& light, auto&& variance, auto&& shift) {
            node.light.diffuse = light;
            node.diffuse_variance = variance;
            node.diffuse_shift = shift;
        });
    smooth_light(
        &NodeRadiance::glossy, variances_of_glossy,
        [](const NodeSurface& surface) { return surface.is_glossy; },
        [](SmoothNode& node, auto&& light, auto&& variance, auto&&) {
            node.light.glossy = light;
            node.glossy_variance = variance;
        });
    for (std::size_t n = 0; n < raw.size(); ++n) nodes[n].surface = raw[n].surface;
    return nodes;
}

void smooth_water(const Grid2D<RadianceNode>& raw, const NodeWindow& window,
                  const DistanceIntervals& intervals, std::size_t groups, std::size_t bands,
                  Grid2D<SmoothNode>& nodes) {
    std::vector<std::vector<float>> variances(raw.size());
    parallel_for(raw.size(), [&](std::size_t n) {
        variances[n] = variances_of_water(raw, static_cast<int>(n) % raw.width(),
                                          static_cast<int>(n) / raw.width());
    });
    for (int j = window.j0; j < window.j1; ++j)
        for (int i = window.i0; i < window.i1; ++i) {
            SmoothNode& node = nodes(i, j);
            node.light.water.assign(intervals.count() * groups * bands, 0.0F);
            node.water_variance.assign(bands, 0.0F);
            for (std::vector<float>& shift : node.water_shift) shift.assign(bands, 0.0F);
        }
    std::vector<NodeReach> reach(raw.size());
    for (std::size_t interval = 0; interval < intervals.count(); ++interval) {
        for (std::size_t n = 0; n < raw.size(); ++n)
            reach[n] = reach_into(raw[n], intervals, interval);
        const LatticeLight light =
            light_of_interval(raw, interval, reach, variances, groups, bands);
        const SmoothedLight smoothed = smooth(
            light, window,
            [&](std::size_t, std::size_t other, bool strictly) {
                return reach[other] >= (strictly ? NodeReach::enough : NodeReach::little);
            },
            [](std::size_t, std::size_t) { return true; });
        // What lies behind an interval that no node reaches is unknown.
        const double before = interval == 0 ? 0 : intervals.end(interval - 1);
        for (int j = window.j0; j < window.j1; ++j)
            for (int i = window.i0; i < window.i1; ++i) {
                const std::size_t n = raw.index(i, j);
                SmoothNode& node = nodes[n];
                if (node.known_to != before) continue;
                // Water that scatters nothing is known to be dark.
                if (!smoothed.is_known[n] && !is_reached(raw, intervals, interval, i, j)) continue;
                node.known_to = intervals.end(interval);
                std::copy_n(&smoothed.light[n * light.values], light.values,
                            &node.light.water[interval * light.values]);
                if (!raw[n].has_ray) continue;
                for (std::size_t b = 0; b < bands; ++b) {
                    const float weight = raw[n].weights[interval * bands + b];
                    node.water_variance[b] += smoothed.variances[n * bands + b] * weight * weight;
                    for (const std::size_t half : {0U, 1U})
                        node.water_shift[half][b] += smoothed.shifts[half][n * bands + b] * weight;
                }
            }
    }
}

}  // namespace uw
