#include "core/forward/slab_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"

namespace uw {

namespace {

// Light in a form that can be blurred: finite and non-negative.
float bounded(double value) {
    constexpr double k_most = 1e30;
    return value > 0 ? static_cast<float>(std::min(value, k_most)) : 0.0F;
}

/// Positions of the nodes of one line among those of another on the same stretch, both at the
/// centres of equal parts: linear interpolation, and extrapolation by half a part at the ends.
struct LinearTaps {
    std::vector<int> first;
    std::vector<float> fraction;  // towards the next

    LinearTaps(int from, int to) {
        for (int i = 0; i < to; ++i) {
            const double at = (i + 0.5) * from / to - 0.5;
            const int node = std::clamp(static_cast<int>(std::floor(at)), 0, std::max(0, from - 2));
            first.push_back(node);
            fraction.push_back(from > 1 ? static_cast<float>(at - node) : 0.0F);
        }
    }
};

}  // namespace

SlabImages::SlabImages(int width, int height, std::size_t groups, std::size_t bands,
                       std::size_t constituents)
    : light(groups, std::vector<ImagePlane>(bands, ImagePlane(width, height))),
      weight(bands, ImagePlane(width, height)),
      from_lamps(width, height, constituents),
      to_camera(width, height, constituents) {}

SlabLattice::SlabLattice(const PixelRenderer& renderer, const InScatterSlabs& slabs,
                         const VisibleWater& water, std::vector<std::vector<std::size_t>> groups,
                         const SensorModel& sensor, double spacing)
    : renderer_(renderer),
      slabs_(slabs),
      water_(water),
      groups_(std::move(groups)),
      sensor_(sensor),
      rays_(SplineLine::node_count(water.width(), spacing),
            SplineLine::node_count(water.height(), spacing)) {
    parallel_for(static_cast<std::size_t>(rows()), [&](std::size_t j) {
        for (int i = 0; i < columns(); ++i)
            rays_(i, static_cast<int>(j)) = find_ray(i, static_cast<int>(j));
    });
}

SlabImages SlabLattice::images() const {
    return {columns(), rows(), groups_.size(), static_cast<std::size_t>(renderer_.band_count()),
            renderer_.scene().medium->constituents.size()};
}

SlabLattice::NodeRay SlabLattice::find_ray(int i, int j) const {
    // The pixels whose centre lies in the node's part of the image.
    const auto begin = [](int node, int nodes, int pixels) {
        return static_cast<int>(std::ceil(1.0 * node * pixels / nodes - 0.5));
    };
    double deepest = 0;
    int x = 0, y = 0;
    for (int v = begin(j, rows(), water_.height()); v < begin(j + 1, rows(), water_.height()); ++v)
        for (int u = begin(i, columns(), water_.width());
             u < begin(i + 1, columns(), water_.width()); ++u) {
            const double end =
                water_.end(static_cast<std::size_t>(v) * static_cast<std::size_t>(water_.width()) +
                           static_cast<std::size_t>(u));
            if (end <= deepest) continue;
            deepest = end;
            x = u;
            y = v;
        }
    NodeRay node;
    if (deepest == 0) return node;
    PixelView view;
    view.x = (i + 0.5) * water_.width() / columns();
    view.y = (j + 0.5) * water_.height() / rows();
    view.ray = renderer_.rays().refracted_ray(view.x, view.y);
    const auto slab_of = [&](double z) {
        std::size_t slab = 0;
        while (slab < slabs_.count() && slabs_.face(slab + 1) < z) ++slab;
        return slab;
    };
    if (view.ray) {
        const bool hits = renderer_.scene().surfaces->closest_hit(*view.ray, k_far, view.hit);
        node.end = hits ? view.hit.distance : k_far;
    }
    if (!view.ray || slab_of(slabs_.depth(*view.ray).z(node.end)) < slab_of(deepest)) {
        renderer_.trace(x, y, view);
        node.end = slabs_.depth(*view.ray).distance(deepest);
    }
    node.ray = view.ray;
    view.has_hit = false;  // only factors that do not depend on it are applied before the blur
    if (sensor_.factors_before_blur()) node.factor = renderer_.pixel_factor(view);
    return node;
}

void SlabLattice::integrate(std::size_t first, std::vector<SlabImages>& slabs) const {
    std::vector<Grid2D<char>> visible(slabs.size(), Grid2D<char>(columns(), rows()));
    parallel_for(static_cast<std::size_t>(rows()), [&](std::size_t j) {
        thread_local std::vector<SlabLight> lights;
        for (int i = 0; i < columns(); ++i) {
            const std::size_t node = rays_.index(i, static_cast<int>(j));
            const NodeRay& ray = rays_[node];
            if (!ray.ray) continue;
            slabs_.integrate(*ray.ray, ray.end, first, first + slabs.size(), lights);
            for (std::size_t n = 0; n < slabs.size(); ++n) {
                if (!lights[n].visible) continue;
                visible[n][node] = 1;
                store(lights[n], ray, node, slabs[n]);
            }
        }
    });
    parallel_for(slabs.size(), [&](std::size_t n) { fill_hidden(visible[n], slabs[n]); });
}

void SlabLattice::store(const SlabLight& light, const NodeRay& ray, std::size_t node,
                        SlabImages& slab) const {
    for (std::size_t b = 0; b < slab.weight.size(); ++b) {
        slab.weight[b][node] = bounded(light.weight[b] * ray.factor);
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            double sum = 0;
            for (const std::size_t j : groups_[g]) sum += light.lamps[j][b];
            slab.light[g][b][node] = bounded(sum);
        }
    }
    slab.from_lamps.set(node, light.to_lamps);
    slab.to_camera.set(node, light.to_camera);
}

void SlabLattice::fill_hidden(Grid2D<char>& visible, SlabImages& slab) {
    // Pixels are at most one node away from a node that sees what they see.
    constexpr int k_rounds = 2;
    for (int round = 0; round < k_rounds; ++round) {
        const Grid2D<char> before = visible;
        for (int y = 0; y < visible.height(); ++y) {
            for (int x = 0; x < visible.width(); ++x) {
                if (before(x, y) != 0) continue;
                std::vector<std::size_t> seen;
                for (int v = std::max(0, y - 1); v < std::min(y + 2, visible.height()); ++v)
                    for (int u = std::max(0, x - 1); u < std::min(x + 2, visible.width()); ++u)
                        if (before(u, v) != 0) seen.push_back(before.index(u, v));
                if (seen.empty()) continue;
                const std::size_t node = before.index(x, y);
                visible[node] = 1;
                slab.fill_from(slab, [&](const ImagePlane& from, ImagePlane& to) {
                    float sum = 0;
                    for (const std::size_t i : seen) sum += from[i];
                    to[node] = sum / static_cast<float>(seen.size());
                });
            }
        }
    }
}

void SlabLattice::interpolate(const ImagePlane& plane, const SplineGrid& grid,
                              ImagePlane& nodes) const {
    if (grid.columns() == columns() && grid.rows() == rows()) {
        nodes = plane;
        return;
    }
    nodes.resize(grid.columns(), grid.rows());
    const LinearTaps across(columns(), grid.columns()), down(rows(), grid.rows());
    parallel_for(static_cast<std::size_t>(grid.rows()), [&](std::size_t j) {
        const int y = down.first[j], next = std::min(y + 1, rows() - 1);
        const std::span<const float> upper = plane.row(y), lower = plane.row(next);
        const std::span<float> out = nodes.row(static_cast<int>(j));
        const float v = down.fraction[j];
        for (std::size_t i = 0; i < out.size(); ++i) {
            const auto x = static_cast<std::size_t>(across.first[i]);
            const std::size_t right = std::min(x + 1, upper.size() - 1);
            const float u = across.fraction[i];
            const float above = upper[x] + u * (upper[right] - upper[x]);
            const float below = lower[x] + u * (lower[right] - lower[x]);
            out[i] = std::max(0.0F, above + v * (below - above));
        }
    });
}

}  // namespace uw
