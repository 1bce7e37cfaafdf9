#include "core/frame/node_smoothing.h"

#include <algorithm>
#include <vector>

#include "core/base/parallel.h"
#include "core/frame/lattice_fit.h"

namespace uw {

namespace {

// An interval that a surface cuts counts if this share of its light lies before it.
constexpr double k_least_share = 0.3;
// Differences between fits that do not matter, relative to the light of the nodes around.
constexpr double k_tolerance = 1e-3;

/// The nodes around one that take part in a fit.
class Neighbourhood {
  public:
    /// `of(node)` is the node's FitNode without its place, or empty if it takes no part.
    template <class Of>
    void find(const Grid2D<MultipleNode>& raw, int i, int j, const Of& of) {
        constexpr int k_reach = LatticeFit::k_reach;
        nodes_.clear();
        light_ = 0;
        for (int v = std::max(0, j - k_reach); v <= std::min(raw.height() - 1, j + k_reach); ++v) {
            for (int u = std::max(0, i - k_reach); u <= std::min(raw.width() - 1, i + k_reach);
                 ++u) {
                std::optional<FitNode> node = of(raw(u, v));
                if (!node) continue;
                node->dx = u - i;
                node->dy = v - j;
                node->index = raw.index(u, v);
                nodes_.push_back(*node);
                light_ += raw(u, v).mean_light;
            }
        }
        light_ /= std::max(1.0, static_cast<double>(nodes_.size()));
    }

    std::span<const FitNode> nodes() const { return nodes_; }
    /// The mean of their light.
    double light() const { return light_; }

  private:
    std::vector<FitNode> nodes_;
    double light_ = 0;
};

/// The nodes with each variance averaged over those around: that of a few batches says little by
/// itself, and that of the whole neighbourhood would hide features of its dark parts.
Grid2D<MultipleNode> with_mean_variances(const Grid2D<MultipleNode>& raw) {
    constexpr int k_reach = k_smoothing_reach - LatticeFit::k_reach;
    Grid2D<MultipleNode> nodes = raw;
    parallel_for(raw.size(), [&](std::size_t at) {
        const int i = static_cast<int>(at) % raw.width(), j = static_cast<int>(at) / raw.width();
        MultipleNode& node = nodes(i, j);
        std::ranges::fill(node.water_variance, 0.0F);
        node.diffuse_variance = 0;
        float waters = 0;
        double surfaces = 0;
        for (int v = std::max(0, j - k_reach); v <= std::min(raw.height() - 1, j + k_reach); ++v) {
            for (int u = std::max(0, i - k_reach); u <= std::min(raw.width() - 1, i + k_reach);
                 ++u) {
                const MultipleNode& other = raw(u, v);
                if (!other.has_ray) continue;
                ++waters;
                for (std::size_t k = 0; k < node.water_variance.size(); ++k)
                    node.water_variance[k] += other.water_variance[k];
                if (!other.surface) continue;
                ++surfaces;
                node.diffuse_variance += other.diffuse_variance;
            }
        }
        for (float& variance : node.water_variance) variance /= std::max(waters, 1.0F);
        node.diffuse_variance /= std::max(surfaces, 1.0);
    });
    return nodes;
}

class NodeSmoothing {
  public:
    NodeSmoothing(const Grid2D<MultipleNode>& raw, const DistanceIntervals& intervals,
                  std::size_t groups, std::size_t bands)
        : raw_(raw), intervals_(intervals), bands_(bands), values_(groups * bands) {}

    void smooth(int i, int j, SmoothNode& node) const {
        const MultipleNode& own = raw_(i, j);
        node.mean_light = own.mean_light;
        smooth_water(i, j, node);
        if (own.surface) smooth_surface(i, j, node);
    }

  private:
    void smooth_water(int i, int j, SmoothNode& node) const;
    void smooth_surface(int i, int j, SmoothNode& node) const;

    const Grid2D<MultipleNode>& raw_;
    const DistanceIntervals& intervals_;
    std::size_t bands_, values_;
};

void NodeSmoothing::smooth_water(int i, int j, SmoothNode& node) const {
    thread_local LatticeFit fit;
    thread_local Neighbourhood near;
    node.light.water.assign(intervals_.count() * values_, 0.0F);
    for (std::size_t interval = 0; interval < intervals_.count(); ++interval) {
        for (std::size_t half = 0; half < 2; ++half) {
            near.find(raw_, i, j, [&](const MultipleNode& other) -> std::optional<FitNode> {
                const double share =
                    other.has_ray ? intervals_.share(interval, 0, other.reach) : 0.0;
                if (share < k_least_share) return std::nullopt;
                FitNode of;
                of.value = other.halves[1 - half].water_mean[interval] / share;
                of.variance = other.water_variance[interval] / (share * share);
                return of;
            });
            if (near.nodes().empty()) return;
            for (const FitWeight& weight : fit.fit(near.nodes(), k_tolerance * near.light())) {
                const MultipleNode& other = raw_[weight.index];
                const float* water = &other.halves[half].water[interval * values_];
                for (std::size_t k = 0; k < values_; ++k) {
                    const double share = intervals_.share(interval, k % bands_, other.reach);
                    node.light.water[interval * values_ + k] +=
                        static_cast<float>(0.5 * weight.weight * water[k] / share);
                }
            }
            // Nothing is seen of the water behind the node's own surface.
            if (intervals_.begin(interval) < raw_(i, j).reach)
                node.variance += 0.25 * fit.variance();
        }
        node.known_to = intervals_.end(interval);
    }
}

void NodeSmoothing::smooth_surface(int i, int j, SmoothNode& node) const {
    thread_local LatticeFit fit;
    thread_local Neighbourhood near;
    const MultipleNode& own = raw_(i, j);
    node.surface = own.surface;
    node.light.diffuse.assign(values_, 0.0F);
    node.light.glossy.assign(own.surface->is_glossy ? values_ : 0, 0.0F);
    for (std::size_t half = 0; half < 2; ++half) {
        near.find(raw_, i, j, [&](const MultipleNode& other) -> std::optional<FitNode> {
            if (!other.surface || other.surface->object_id != own.surface->object_id ||
                other.surface->is_glossy != own.surface->is_glossy ||
                glm::dot(other.surface->normal, own.surface->normal) < k_least_node_cosine)
                return std::nullopt;
            FitNode of;
            of.value = other.halves[1 - half].diffuse_mean;
            of.variance = other.diffuse_variance;
            return of;
        });
        const double tolerance = k_tolerance * near.light() / std::max(own.surface_seen, 1e-3);
        for (const FitWeight& weight : fit.fit(near.nodes(), tolerance)) {
            const NodeLight& other = raw_[weight.index].halves[half];
            const auto share = static_cast<float>(0.5 * weight.weight);
            for (std::size_t k = 0; k < values_; ++k)
                node.light.diffuse[k] += share * other.diffuse[k];
            for (std::size_t k = 0; k < node.light.glossy.size(); ++k)
                node.light.glossy[k] += share * other.glossy[k];
        }
        node.variance += 0.25 * fit.variance() * own.surface_seen * own.surface_seen;
    }
}

}  // namespace

Grid2D<SmoothNode> smoothed(const Grid2D<MultipleNode>& raw, const DistanceIntervals& intervals,
                            std::size_t groups) {
    Grid2D<SmoothNode> nodes;
    nodes.assign(raw.width(), raw.height());
    std::size_t values = 0;
    for (const MultipleNode& node : raw) values = std::max(values, node.halves[0].water.size());
    if (values == 0) return nodes;
    const Grid2D<MultipleNode> averaged = with_mean_variances(raw);
    const NodeSmoothing smoothing(averaged, intervals, groups,
                                  values / (intervals.count() * groups));
    parallel_for(raw.size(), [&](std::size_t at) {
        const int i = static_cast<int>(at) % raw.width(), j = static_cast<int>(at) / raw.width();
        smoothing.smooth(i, j, nodes(i, j));
    });
    return nodes;
}

}  // namespace uw
