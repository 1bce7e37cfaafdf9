#include "core/frame/in_scatter_lattice.h"

#include <algorithm>
#include <cmath>

namespace uw {

namespace {

// How far a node's distances may reach beyond the nearest, relative: over them a parabola follows
// the in-scatter to a tenth of the tolerance.
double distance_reach(double tolerance) {
    return 0.12 * std::cbrt(tolerance / 1e-3);
}

// Light darker than this share of the tile's mean is compared with that.
constexpr double k_dark = 0.02;

// Place of (x, y) in rows of `width`.
std::size_t pixel_index(int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
}

}  // namespace

/// Where in a cell something is mixed, and up to which distances.
struct InScatterLattice::Place {
    double u, v;  // 0..1 across and down the cell
    std::span<const double> ends, shares;
};

InScatterLattice::InScatterLattice(const RaySource& rays, const RayInScatter& water,
                                   double tolerance)
    : rays_(rays),
      water_(water),
      tolerance_(tolerance),
      distance_reach_(distance_reach(tolerance)),
      row_size_(water.row_size()),
      floor_(water.band_count()),
      mixed_(row_size_),
      own_(row_size_) {}

const PixelView* InScatterLattice::view(int x, int y) const {
    if (x < 0 || y < 0 || x >= tile_.width() || y >= tile_.height()) return nullptr;
    const PixelView& view = views_[pixel_index(x, y, tile_.width())];
    return view.ends.empty() ? nullptr : &view;
}

void InScatterLattice::gather(const PixelWindow& tile, std::span<const PixelView> views) {
    tile_ = tile;
    views_ = views;
    rows_.assign(views.size() * row_size_, 0.0);
    collect_ends();
    nodes_.assign(static_cast<std::size_t>(k_side) * k_side, Node{});
    node_rows_.clear();
    set_floor();
    for (int j = 0; j < tile.height(); j += k_coarsest)
        for (int i = 0; i < tile.width(); i += k_coarsest) fill_cell(i, j, k_coarsest);
}

void InScatterLattice::collect_ends() {
    ends_.clear();
    first_ends_.clear();
    for (const PixelView& view : views_) {
        first_ends_.push_back(ends_.size());
        ends_.insert(ends_.end(), view.ends.begin(), view.ends.end());
    }
    first_ends_.push_back(ends_.size());
}

const InScatterLattice::Node& InScatterLattice::node(int i, int j) {
    Node& node = nodes_[pixel_index(i / k_finest, j / k_finest, k_side)];
    if (node.state == Node::State::unknown) {
        find_depths(i, j, node);
        const bool ready = node.reach > 0 && gather_node(i, j, node);
        node.state = ready ? Node::State::ready : Node::State::unusable;
    }
    return node;
}

/// The depths at which the water ends around a node, as far around it as there are few.
void InScatterLattice::find_depths(int i, int j, Node& node) const {
    int reach = k_coarsest;
    while (i % reach != 0 || j % reach != 0) reach /= 2;
    for (; reach >= k_finest; reach /= 2) {
        node.depth_count = 0;
        bool few = true;
        // A node beyond the image's edge may reach none of its pixels.
        const int x0 = std::clamp(i - reach, 0, tile_.width());
        const int x1 = std::min(i + reach, tile_.width() - 1);
        const int y0 = std::max(0, j - reach), y1 = std::min(j + reach, tile_.height() - 1);
        for (int y = y0; y <= y1 && few; ++y) {
            const std::size_t* first = &first_ends_[pixel_index(0, y, tile_.width())];
            for (std::size_t end = first[x0]; end < first[x1 + 1] && few; ++end)
                few = include(ends_[end], node);
        }
        if (!few) continue;
        if (node.depth_count > 0) node.reach = reach;
        return;
    }
}

/// Makes `end` part of one of the node's depths; false if it has too many already.
bool InScatterLattice::include(double end, Node& node) const {
    for (std::size_t d = 0; d < node.depth_count; ++d) {
        Depth& depth = node.depths[d];
        if (end >= depth.least && end <= depth.greatest) return true;
        const double least = std::min(depth.least, end), greatest = std::max(depth.greatest, end);
        if (greatest > (1 + distance_reach_) * least) continue;
        depth = {least, greatest};
        return true;
    }
    if (node.depth_count == k_depths) return false;
    node.depths[node.depth_count++] = {end, end};
    return true;
}

bool InScatterLattice::gather_node(int i, int j, Node& node) {
    const auto ray = rays_.refracted_ray(tile_.x0 + i + 0.5, tile_.y0 + j + 0.5);
    if (!ray) return false;
    std::array<double, k_depths * k_stops> distances{};
    std::size_t count = 0;
    for (std::size_t d = 0; d < node.depth_count; ++d) {
        const Depth& depth = node.depths[d];
        distances[count++] = depth.least;
        if (depth.alike()) continue;
        distances[count++] = depth.middle();
        distances[count++] = depth.greatest;
    }
    node.rows = node_rows_.size();
    node_rows_.resize(node.rows + count * row_size_);
    water_.gather(*ray, std::span(distances).first(count),
                  std::span(node_rows_).subspan(node.rows));
    return true;
}

void InScatterLattice::set_floor() {
    std::fill(floor_.begin(), floor_.end(), 0.0);
    std::size_t count = 0;
    for (int j = 0; j < tile_.height(); j += k_coarsest) {
        for (int i = 0; i < tile_.width(); i += k_coarsest) {
            const Node& at = node(i, j);
            if (at.state != Node::State::ready) continue;
            ++count;
            for (std::size_t k = 0; k < water_.group_count() * floor_.size(); ++k)
                floor_[k % floor_.size()] += node_rows_[at.rows + k];
        }
    }
    for (double& value : floor_)
        if (count > 0) value *= k_dark / static_cast<double>(count);
}

bool InScatterLattice::corners(int i, int j, int spacing, Corners& found) {
    for (std::size_t c = 0; c < found.size(); ++c) {
        const int right = c % 2 != 0 ? spacing : 0, below = c / 2 != 0 ? spacing : 0;
        const Node& corner = node(i + right, j + below);
        if (corner.state != Node::State::ready || corner.reach < spacing) return false;
        found[c] = &corner;
    }
    return true;
}

bool InScatterLattice::confirmed(int i, int j, int spacing) {
    // Pointers stay: all nodes have their place from the start.
    Corners from{};
    if (!corners(i, j, spacing, from)) return false;
    const int half = spacing / 2;
    // What five nodes do not see of a large cell is seen of a small one.
    const double allowed = tolerance_ * k_coarsest / spacing;
    for (int v = 0; v <= 2; ++v) {
        for (int u = 0; u <= 2; ++u) {
            if (u != 1 && v != 1) continue;
            const Node& middle = node(i + u * half, j + v * half);
            if (middle.state != Node::State::ready || middle.reach < half) return false;
            // Up to all that is seen around it, not only what the node itself looks at.
            constexpr std::array<double, 1> k_whole{1.0};
            for (std::size_t d = 0; d < middle.depth_count; ++d) {
                for (const double& end : {middle.depths[d].least, middle.depths[d].greatest}) {
                    const Place place{0.5 * u, 0.5 * v, std::span(&end, 1), k_whole};
                    if (!agree(from, place, middle, allowed)) return false;
                }
            }
        }
    }
    return true;
}

bool InScatterLattice::agree(const Corners& from, const Place& place, const Node& node,
                             double allowed) {
    std::fill(mixed_.begin(), mixed_.end(), 0.0);
    std::fill(own_.begin(), own_.end(), 0.0);
    for (std::size_t c = 0; c < from.size(); ++c) {
        const double across = c % 2 != 0 ? place.u : 1 - place.u;
        const double down = c / 2 != 0 ? place.v : 1 - place.v;
        if (across * down > 0 && !add(*from[c], across * down, place.ends, place.shares, mixed_))
            return false;
    }
    if (!add(node, 1, place.ends, place.shares, own_)) return false;
    const std::size_t bands = floor_.size();
    for (std::size_t b = 0; b < bands; ++b) {
        double difference = 0, light = 0;
        for (std::size_t k = b; k < water_.group_count() * bands; k += bands) {
            difference += mixed_[k] - own_[k];
            light += own_[k];
        }
        if (!(std::abs(difference) <= allowed * std::max(light, floor_[b]))) return false;
    }
    return true;
}

void InScatterLattice::fill_cell(int i, int j, int spacing) {
    if (i >= tile_.width() || j >= tile_.height()) return;
    const int half = spacing / 2;
    const bool mix = confirmed(i, j, spacing);
    if (!mix && half >= k_finest * 2) {
        for (const int v : {0, half})
            for (const int u : {0, half}) fill_cell(i + u, j + v, half);
        return;
    }
    for (int y = j; y < std::min(j + spacing, tile_.height()); ++y)
        for (int x = i; x < std::min(i + spacing, tile_.width()); ++x)
            fill_pixel(x, y, mix ? half : 0);
}

/// `spacing` of the lattice that the pixel is mixed from; 0: from none.
void InScatterLattice::fill_pixel(int x, int y, int spacing) {
    const PixelView* seen = view(x, y);
    if (seen == nullptr) return;
    const std::size_t pixel = pixel_index(x, y, tile_.width());
    const std::span row = std::span(rows_).subspan(pixel * row_size_, row_size_);
    Corners from{};
    if (spacing == 0 || !corners(x - x % spacing, y - y % spacing, spacing, from)) {
        water_.gather(*seen, row);
        return;
    }
    const double u = static_cast<double>(x % spacing) / spacing;
    const double v = static_cast<double>(y % spacing) / spacing;
    for (std::size_t c = 0; c < from.size(); ++c) {
        const double weight = (c % 2 != 0 ? u : 1 - u) * (c / 2 != 0 ? v : 1 - v);
        // Corners know the depths of all pixels within their reach.
        if (weight > 0) add(*from[c], weight, seen->ends, seen->shares, row);
    }
}

/// Adds `weight` times what the node's parabolas say of the mean over the ends.
bool InScatterLattice::add(const Node& node, double weight, std::span<const double> ends,
                           std::span<const double> shares, std::span<double> row) const {
    for (std::size_t end = 0; end < ends.size(); ++end) {
        const double* rows = &node_rows_[node.rows];
        std::size_t d = 0;
        for (; d < node.depth_count; ++d) {
            const Depth& depth = node.depths[d];
            if (ends[end] >= depth.least && ends[end] <= depth.greatest) break;
            rows += depth.stops() * row_size_;
        }
        if (d == node.depth_count) return false;
        const Depth& depth = node.depths[d];
        const double share = weight * shares[end];
        if (depth.alike()) {
            for (std::size_t k = 0; k < row_size_; ++k) row[k] += share * rows[k];
            continue;
        }
        // -1..1 from the nearest to the farthest.
        const double t = 2 * (ends[end] - depth.middle()) / (depth.greatest - depth.least);
        const double of_least = share * 0.5 * t * (t - 1), of_middle = share * (1 - t * t);
        const double of_greatest = share * 0.5 * t * (t + 1);
        for (std::size_t k = 0; k < row_size_; ++k)
            row[k] += of_least * rows[k] + of_middle * rows[row_size_ + k] +
                      of_greatest * rows[2 * row_size_ + k];
    }
    return true;
}

}  // namespace uw
