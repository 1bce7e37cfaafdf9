#include "core/frame/in_scatter_lattice.h"

#include <algorithm>
#include <cmath>

namespace uw {

namespace {

// Greatest relative width of a depth (greatest over least distance, minus 1) for which a parabola
// follows the in-scatter to a tenth of the tolerance.
double distance_reach(double tolerance) {
    return 0.12 * std::cbrt(tolerance / 1e-3);
}

// Errors in radiance below this fraction of the tile's mean are measured relative to that level.
constexpr double k_dark = 0.02;

}  // namespace

/// The position within a cell at which to interpolate, and the distances.
struct InScatterLattice::Place {
    double u, v;  // 0..1 across and down the cell
    std::span<const double> distances, weights;
};

InScatterLattice::InScatterLattice(const RaySource& rays, const LitScene& scene,
                                   const RayInScatter& in_scatter, double tolerance)
    : rays_(rays),
      in_scatter_(in_scatter),
      tolerance_(tolerance),
      distance_reach_(distance_reach(tolerance)),
      value_count_(in_scatter.value_count()),
      beams_(rays, *scene.emitters),
      particles_(rays, scene),
      floor_(in_scatter.band_count()),
      interpolated_(value_count_),
      integrated_(value_count_) {}

void InScatterLattice::evaluate(const PixelWindow& tile, const Grid2D<PixelView>& views) {
    tile_ = tile;
    views_ = &views;
    pixel_values_.assign(views.size() * value_count_, 0.0);
    collect_distances();
    nodes_.assign(k_side, k_side);
    node_values_.clear();
    set_floor();
    const double reach =
        distances_.empty() ? 0 : *std::max_element(distances_.begin(), distances_.end());
    beams_.begin(cell(0, 0, k_coarsest), k_coarsest / 2, reach);
    particles_.begin(tile, k_tile, reach);
    for (int j = 0; j < tile.height(); j += k_coarsest)
        for (int i = 0; i < tile.width(); i += k_coarsest) fill_cell(i, j, k_coarsest);
}

void InScatterLattice::collect_distances() {
    distances_.clear();
    first_distances_.clear();
    for (const PixelView& view : *views_) {
        first_distances_.push_back(distances_.size());
        distances_.insert(distances_.end(), view.distances.begin(), view.distances.end());
    }
    first_distances_.push_back(distances_.size());
}

const InScatterLattice::Node& InScatterLattice::node(int i, int j) {
    Node& node = nodes_(i / k_finest, j / k_finest);
    if (node.state == Node::State::unknown) {
        find_depths(i, j, node);
        const bool ready = node.reach > 0 && integrate_node(i, j, node);
        node.state = ready ? Node::State::ready : Node::State::unusable;
    }
    return node;
}

/// The depths at which the water ends in the pixels around a node, within the radius where there
/// are few of them.
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
            const std::size_t* first = &first_distances_[views_->index(0, y)];
            for (std::size_t at = first[x0]; at < first[x1 + 1] && few; ++at)
                few = include(distances_[at], node);
        }
        if (!few) continue;
        if (node.depth_count > 0) node.reach = reach;
        return;
    }
}

/// Includes `distance` in one of the node's depths; false if it already has too many.
bool InScatterLattice::include(double distance, Node& node) const {
    for (std::size_t d = 0; d < node.depth_count; ++d) {
        Depth& depth = node.depths[d];
        if (distance >= depth.least && distance <= depth.greatest) return true;
        const double least = std::min(depth.least, distance);
        const double greatest = std::max(depth.greatest, distance);
        if (greatest > (1 + distance_reach_) * least) continue;
        depth = {least, greatest};
        return true;
    }
    if (node.depth_count == k_depths) return false;
    node.depths[node.depth_count++] = {distance, distance};
    return true;
}

bool InScatterLattice::integrate_node(int i, int j, Node& node) {
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
    node.values = node_values_.size();
    node_values_.resize(node.values + count * value_count_);
    in_scatter_.integrate(*ray, std::span(distances).first(count),
                          std::span(node_values_).subspan(node.values));
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
            for (std::size_t k = 0; k < in_scatter_.group_count() * floor_.size(); ++k)
                floor_[k % floor_.size()] += node_values_[at.values + k];
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
    // Pointers stay valid: all nodes are allocated from the start.
    Corners from{};
    if (!corners(i, j, spacing, from)) return false;
    const int half = spacing / 2;
    // Few pixels lie in small cells, and features that five nodes miss in a large one are found
    // by those of smaller ones.
    const double allowed = tolerance_ * std::sqrt(static_cast<double>(k_coarsest) / spacing);
    for (int v = 0; v <= 2; ++v) {
        for (int u = 0; u <= 2; ++u) {
            if (u != 1 && v != 1) continue;
            const Node& middle = node(i + u * half, j + v * half);
            if (middle.state != Node::State::ready || middle.reach < half) return false;
            // Up to every surface seen around the node, not only the one it sees itself.
            constexpr std::array<double, 1> k_whole{1.0};
            for (std::size_t d = 0; d < middle.depth_count; ++d) {
                for (const double& distance : {middle.depths[d].least, middle.depths[d].greatest}) {
                    const Place place{0.5 * u, 0.5 * v, std::span(&distance, 1), k_whole};
                    if (!agree(from, place, middle, allowed)) return false;
                }
            }
        }
    }
    return !has_fine(i, j, spacing);
}

ImageRectangle InScatterLattice::cell(int i, int j, int spacing) const {
    const int x = tile_.x0 + i, y = tile_.y0 + j;
    return {static_cast<double>(x), static_cast<double>(y),
            static_cast<double>(std::min(x + spacing + 1, tile_.x1)),
            static_cast<double>(std::min(y + spacing + 1, tile_.y1))};
}

bool InScatterLattice::has_fine(int i, int j, int spacing) {
    const int half = spacing / 2;
    if (beams_.has_any(cell(i, j, spacing), half)) return true;
    return half > FineParticles::k_spacing && particles_.has_any(i, j, spacing, half);
}

bool InScatterLattice::agree(const Corners& from, const Place& place, const Node& node,
                             double allowed) {
    std::fill(interpolated_.begin(), interpolated_.end(), 0.0);
    std::fill(integrated_.begin(), integrated_.end(), 0.0);
    for (std::size_t c = 0; c < from.size(); ++c) {
        const double across = c % 2 != 0 ? place.u : 1 - place.u;
        const double down = c / 2 != 0 ? place.v : 1 - place.v;
        if (across * down > 0 &&
            !add_node(*from[c], across * down, place.distances, place.weights, interpolated_))
            return false;
    }
    if (!add_node(node, 1, place.distances, place.weights, integrated_)) return false;
    const std::size_t bands = floor_.size();
    for (std::size_t b = 0; b < bands; ++b) {
        double difference = 0, light = 0;
        for (std::size_t k = b; k < in_scatter_.group_count() * bands; k += bands) {
            difference += interpolated_[k] - integrated_[k];
            light += integrated_[k];
        }
        if (!(std::abs(difference) <= allowed * std::max(light, floor_[b]))) return false;
    }
    return true;
}

void InScatterLattice::fill_cell(int i, int j, int spacing) {
    if (i >= tile_.width() || j >= tile_.height()) return;
    const int half = spacing / 2;
    const bool interpolate = confirmed(i, j, spacing);
    if (!interpolate && half >= k_finest * 2) {
        for (const int v : {0, half})
            for (const int u : {0, half}) fill_cell(i + u, j + v, half);
        return;
    }
    for (int y = j; y < std::min(j + spacing, tile_.height()); ++y)
        for (int x = i; x < std::min(i + spacing, tile_.width()); ++x)
            fill_pixel(x, y, interpolate ? half : 0);
}

/// `spacing`: that of the lattice from which the pixel is interpolated; 0: none.
void InScatterLattice::fill_pixel(int x, int y, int spacing) {
    const PixelView& view = (*views_)(x, y);
    if (view.distances.empty()) return;
    const std::span values =
        std::span(pixel_values_).subspan(views_->index(x, y) * value_count_, value_count_);
    Corners from{};
    if (spacing == 0 || !corners(x - x % spacing, y - y % spacing, spacing, from)) {
        in_scatter_.integrate(view, values);
        return;
    }
    const double u = static_cast<double>(x % spacing) / spacing;
    const double v = static_cast<double>(y % spacing) / spacing;
    for (std::size_t c = 0; c < from.size(); ++c) {
        const double weight = (c % 2 != 0 ? u : 1 - u) * (c / 2 != 0 ? v : 1 - v);
        // Corners know the depths of all pixels within their reach.
        if (weight > 0) add_node(*from[c], weight, view.distances, view.weights, values);
    }
    // Parabolas through the light of a lamp that shines behind the surface alone go below zero.
    for (double& value : values) value = std::max(value, 0.0);
}

/// Adds `weight` times the weighted mean over the distances of the node's parabolas.
bool InScatterLattice::add_node(const Node& node, double weight, std::span<const double> distances,
                                std::span<const double> weights, std::span<double> values) const {
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const double* at_stops = &node_values_[node.values];
        std::size_t d = 0;
        for (; d < node.depth_count; ++d) {
            const Depth& depth = node.depths[d];
            if (distances[i] >= depth.least && distances[i] <= depth.greatest) break;
            at_stops += depth.stops() * value_count_;
        }
        if (d == node.depth_count) return false;
        const Depth& depth = node.depths[d];
        const double whole = weight * weights[i];
        if (depth.alike()) {
            for (std::size_t k = 0; k < value_count_; ++k) values[k] += whole * at_stops[k];
            continue;
        }
        // -1..1 from the nearest to the farthest.
        const double t = 2 * (distances[i] - depth.middle()) / (depth.greatest - depth.least);
        const double of_least = whole * 0.5 * t * (t - 1), of_middle = whole * (1 - t * t);
        const double of_greatest = whole * 0.5 * t * (t + 1);
        for (std::size_t k = 0; k < value_count_; ++k)
            values[k] += of_least * at_stops[k] + of_middle * at_stops[value_count_ + k] +
                         of_greatest * at_stops[2 * value_count_ + k];
    }
    return true;
}

}  // namespace uw
