#include "core/passes/water_scatter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"

namespace uw {

namespace {

// Makes a value finite and non-negative, so that it can be blurred.
float bounded(double value) {
    constexpr double k_max = 1e30;
    return value > 0 ? static_cast<float>(std::min(value, k_max)) : 0.0F;
}

/// Positions of the nodes of one line among those of another on the same interval, both at the
/// centres of equal parts, for linear interpolation, and extrapolation by half a part at the ends.
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
    // The first pixel whose centre lies in the node's part of the image.
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
    view.has_hit = false;  // only factors that do not depend on the hit are applied before the blur
    if (sensor_.factors_before_blur()) node.factor = renderer_.pixel_factor(view);
    return node;
}

void SlabLattice::integrate(std::size_t first, std::vector<SlabImages>& slabs) const {
    std::vector<Grid2D<char>> visible(slabs.size(), Grid2D<char>(columns(), rows()));
    parallel_for(static_cast<std::size_t>(rows()), [&](std::size_t j) {
        std::vector<SlabLight> lights;
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
                std::vector<std::size_t> visible_nodes;
                for (int v = std::max(0, y - 1); v < std::min(y + 2, visible.height()); ++v)
                    for (int u = std::max(0, x - 1); u < std::min(x + 2, visible.width()); ++u)
                        if (before(u, v) != 0) visible_nodes.push_back(before.index(u, v));
                if (visible_nodes.empty()) continue;
                const std::size_t node = before.index(x, y);
                visible[node] = 1;
                slab.fill_from(slab, [&](const ImagePlane& from, ImagePlane& to) {
                    float sum = 0;
                    for (const std::size_t i : visible_nodes) sum += from[i];
                    to[node] = sum / static_cast<float>(visible_nodes.size());
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

/// The state of slabs that are scattered on the same grid.
struct WaterScatter::Level {
    Level(double of_spacing, const ForwardScatterDesc& desc, const ScatterPlane& plane,
          const Medium& medium, std::size_t groups)
        : spacing(of_spacing),
          grid(plane.width, plane.height, of_spacing),
          from_lamps(desc, plane, medium, of_spacing),
          slab(grid.columns(), grid.rows(), groups, static_cast<std::size_t>(medium.band_count()),
               medium.constituents.size()) {
        for (std::size_t i = 0; i < groups * slab.weight.size(); ++i) {
            to_camera.emplace_back(desc, plane, medium, of_spacing);
            before.emplace_back(grid.columns(), grid.rows());
            within.emplace_back(grid.columns(), grid.rows());
        }
    }

    double spacing;
    SplineGrid grid;
    PathScatter from_lamps;
    std::vector<PathScatter> to_camera;  // per channel: band of a group
    // The light that (17) adds to each channel in all previous slabs, and in the current one:
    // spline coefficients.
    std::vector<ImagePlane> before, within;
    SlabImages slab;  // at the nodes
    // Means over the pixels around each node: the fraction that sees some of the slab, that
    // fraction times the part of the slab that it sees, and the fraction that sees beyond the slab,
    // whose far face is `visible_at`.
    ImagePlane visible, coverage, visible_next;
    std::size_t visible_at = std::numeric_limits<std::size_t>::max();
    ImagePlane source, values;
};

WaterScatter::WaterScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane,
                           const Medium& medium, const InScatterSlabs& slabs,
                           const VisibleWater& water, const SlabLattice& lattice, double spacing)
    : desc_(desc),
      plane_(plane),
      medium_(medium),
      slabs_(slabs),
      water_(water),
      lattice_(lattice),
      spacing_(spacing),
      extent_(water.extent()),
      pixels_(plane.width, plane.height) {}

WaterScatter::~WaterScatter() = default;

void WaterScatter::add(std::size_t index, const SlabImages& images, std::vector<ImagePlane>& sums) {
    if (extent_.farthest <= slabs_.face(index)) return;
    prepare(index, images, sums);
    level_->slab.fill_from(images, [&](const ImagePlane& from, ImagePlane& to) {
        lattice_.interpolate(from, level_->grid, to);
    });
    if (cut_) find_visible_fractions(index);
    for (std::size_t g = 0; g < level_->slab.light.size(); ++g)
        for (std::size_t b = 0; b < level_->slab.weight.size(); ++b) scatter(g, b);
    if (cut_) gather_ends(index);
    for (std::size_t channel = 0; channel < level_->before.size(); ++channel)
        for (std::size_t i = 0; i < level_->before[channel].size(); ++i)
            level_->before[channel][i] += level_->within[channel][i];
    next_ = index + 1;
}

/// Returns the spacing of the grid for a slab. Where surfaces cut into it, its light has edges, and
/// the grid must be as fine as the narrowest kernel needs. Elsewhere its light is as smooth as the
/// lattice.
double WaterScatter::spacing_for(std::size_t index, const SlabImages& images) const {
    if (!(extent_.nearest < slabs_.face(index + 1))) return spacing_;
    double least = std::numeric_limits<double>::infinity();
    for (const PathImage* path : {&images.from_lamps, &images.to_camera})
        for (const float length : path->length())
            if (length > 0) least = std::min(least, static_cast<double>(length));
    // The grid may be coarser than for surfaces: there are edges, but no textures.
    const bool exponential = desc_.shape == ForwardScatterDesc::Shape::exponential;
    const double nodes_per_width = exponential ? 1.0 : 1.5;
    const double needed = nodes_per_width * ForwardScatter::width_per_metre(desc_, plane_) * least;
    double spacing = spacing_;
    while (spacing > 1 && spacing > needed) spacing /= 2;
    return std::max(1.0, spacing);
}

void WaterScatter::prepare(std::size_t index, const SlabImages& images,
                           std::vector<ImagePlane>& sums) {
    const double spacing = spacing_for(index, images);
    if (level_ && (level_->spacing != spacing || sums_ != &sums)) finish();
    if (!level_)
        level_ = std::make_unique<Level>(spacing, desc_, plane_, medium_, images.light.size());
    sums_ = &sums;
    // Water that ends at the slab's far face counts as ending in the slab, since the pixel sees
    // nothing beyond that face.
    cut_ = extent_.nearest <= slabs_.face(index + 1);
}

void WaterScatter::find_visible_fractions(std::size_t index) {
    Level& level = *level_;
    const double begin = slabs_.face(index), end = slabs_.face(index + 1);
    // Computes the means of `of(pixel)` around each node.
    const auto means = [&](const auto& of, ImagePlane& nodes) {
        level.grid.means(
            [&](int y, std::span<double> row) {
                const std::size_t first = row.size() * static_cast<std::size_t>(y);
                bool any = false;
                for (std::size_t x = 0; x < row.size(); ++x) {
                    row[x] = of(first + x);
                    any = any || row[x] != 0;
                }
                return any;
            },
            nodes);
    };
    if (level.visible_at == index)
        level.visible = level.visible_next;
    else
        means([&](std::size_t pixel) { return water_.beyond(pixel, begin); }, level.visible);
    // Only pixels whose water ends in this slab see more of it than of the next.
    const auto of_ends = [&](const auto& value) {
        return [&, value](std::size_t pixel) {
            double sum = 0;
            water_.for_each(pixel, [&](double fraction, double z) {
                if (z > begin && z <= end) sum += fraction * value(z);
            });
            return sum;
        };
    };
    means(of_ends([](double) { return 1.0; }), level.source);
    means(of_ends([&](double z) { return (z - begin) / (end - begin); }), level.coverage);
    level.visible_next = level.visible;
    for (std::size_t i = 0; i < level.visible.size(); ++i) {
        level.visible_next[i] = std::max(0.0F, level.visible[i] - level.source[i]);
        level.coverage[i] += level.visible_next[i];
    }
    level.visible_at = index + 1;
}

void WaterScatter::scatter(std::size_t group, std::size_t band) {
    Level& level = *level_;
    const std::size_t channel = group * level.slab.weight.size() + band;
    const ImagePlane& light = level.slab.light[group][band];
    const ImagePlane& weight = level.slab.weight[band];
    level.source = light;
    if (cut_)
        for (std::size_t i = 0; i < light.size(); ++i) level.source[i] *= level.visible[i];
    level.from_lamps.add(band, level.source, level.slab.from_lamps, cut_);
    ImagePlane& within = level.within[channel];
    level.from_lamps.finish(within);
    level.grid.values(within, level.values);
    for (std::size_t i = 0; i < light.size(); ++i) {
        const float part = cut_ ? weight[i] * level.coverage[i] : weight[i];
        level.source[i] = part * (light[i] + std::max(0.0F, level.values[i]));
        within[i] *= weight[i];
    }
    level.to_camera[channel].add(band, level.source, level.slab.to_camera, cut_);
}

void WaterScatter::gather_ends(std::size_t index) const {
    const double begin = slabs_.face(index), end = slabs_.face(index + 1);
    parallel_for(static_cast<std::size_t>(plane_.height), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < plane_.width; ++x) {
            const std::size_t pixel = pixels_.index(x, y);
            water_.for_each(pixel, [&](double fraction, double z) {
                if (!(z > begin && z <= end)) return;
                const auto part = static_cast<float>((z - begin) / (end - begin));
                for (std::size_t channel = 0; channel < sums_->size(); ++channel) {
                    const auto [before, within] =
                        level_->grid.at(level_->before[channel], level_->within[channel], x, y);
                    (*sums_)[channel][pixel] +=
                        static_cast<float>(fraction) * std::max(0.0F, before + part * within);
                }
            });
        }
    });
}

void WaterScatter::gather_beyond(const ImagePlane& before, ImagePlane& sum) const {
    const double z = slabs_.face(next_);
    level_->grid.interpolate(before, [&](int y, std::span<const double> row) {
        for (std::size_t x = 0; x < row.size(); ++x) {
            const std::size_t pixel = sum.index(static_cast<int>(x), y);
            sum[pixel] += static_cast<float>(water_.beyond(pixel, z) * std::max(0.0, row[x]));
        }
    });
}

void WaterScatter::finish() {
    if (!level_) return;
    for (std::size_t channel = 0; channel < sums_->size(); ++channel) {
        ImagePlane& sum = (*sums_)[channel];
        gather_beyond(level_->before[channel], sum);
        level_->to_camera[channel].finish_pixels(pixels_);
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += static_cast<float>(water_.alpha(i)) * pixels_[i];
    }
    level_.reset();
}

}  // namespace uw
