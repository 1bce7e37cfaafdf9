#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray_source.h"
#include "core/frame/pixel_view.h"
#include "core/frame/ray_in_scatter.h"
#include "core/image/film.h"

namespace uw {

/// In-scatter of a tile of pixels. From pixel to pixel it is smooth, except at the edges of shadows
/// and surfaces: it is integrated at the nodes of a lattice and interpolated between them, bilinear
/// over the image and by a parabola over distance, where the nodes of the next finer lattice
/// confirm that; elsewhere the lattice is refined, down to every pixel. Reused between tiles.
class InScatterLattice {
  public:
    /// Pixels along a tile's edge. Tiles lie at multiples of it in the full image, so that a window
    /// of an image holds what the whole image does.
    static constexpr int k_tile = 32;

    /// `tolerance`: largest relative difference allowed, halfway between the nodes of the coarsest
    /// lattice, between what is interpolated and what a node there integrates; twice that for the
    /// next finer lattice, and so on. Pixels are interpolated from the halfway nodes as well, and
    /// so come closer. All references outlive this.
    InScatterLattice(const RaySource& rays, const RayInScatter& in_scatter, double tolerance);

    /// Finds the in-scatter of the pixels of `tile` (k_tile along an edge, less at the image's
    /// right and bottom). `views`, of these pixels, outlive what is asked of the lattice then.
    void evaluate(const PixelWindow& tile, const Grid2D<PixelView>& views);

    /// The values (RayInScatter) of one pixel of the tile, by its index among the views; zeros
    /// where no ray enters the water.
    std::span<const double> values(std::size_t pixel) const {
        return std::span(pixel_values_).subspan(pixel * value_count_, value_count_);
    }

  private:
    static constexpr int k_coarsest = 16, k_finest = 2;  // spacings of the lattices [pixels]
    static constexpr int k_side = k_tile / k_finest + 1;
    static constexpr std::size_t k_stops = 3;   // distances of a parabola
    static constexpr std::size_t k_depths = 3;  // surfaces at most around a node

    /// Distances so near each other that a parabola through the least, the greatest and the middle
    /// gives the light up to any of them.
    struct Depth {
        double least = 0, greatest = 0;
        bool alike() const { return greatest <= (1 + 1e-9) * least; }
        std::size_t stops() const { return alike() ? 1 : k_stops; }
        double middle() const { return 0.5 * (least + greatest); }
    };
    /// A ray of the lattice.
    struct Node {
        enum class State { unknown, ready, unusable } state = State::unknown;
        int reach = 0;  // how far around it its depths hold [pixels]
        std::size_t depth_count = 0;
        std::array<Depth, k_depths> depths{};
        std::size_t values = 0;  // index in node_values_ of the first stop of the first depth
    };
    using Corners = std::array<const Node*, 4>;
    struct Place;

    const Node& node(int i, int j);
    void find_depths(int i, int j, Node& node) const;
    bool include(double distance, Node& node) const;
    bool integrate_node(int i, int j, Node& node);
    // The four nodes around the cell at (i, j); false if one of them cannot be used there.
    bool corners(int i, int j, int spacing, Corners& found);
    // Whether what is interpolated between the cell's corners is what the nodes halfway between
    // them integrate.
    bool confirmed(int i, int j, int spacing);
    bool agree(const Corners& from, const Place& place, const Node& node, double allowed);
    void collect_distances();
    void fill_cell(int i, int j, int spacing);
    void fill_pixel(int x, int y, int spacing);
    void set_floor();
    // False if one of the distances lies within no depth of the node.
    bool add_node(const Node& node, double weight, std::span<const double> distances,
                  std::span<const double> weights, std::span<double> values) const;

    const RaySource& rays_;
    const RayInScatter& in_scatter_;
    double tolerance_;
    double distance_reach_;
    std::size_t value_count_;

    PixelWindow tile_;
    const Grid2D<PixelView>* views_ = nullptr;
    std::vector<double> distances_;             // of all views, one after another
    std::vector<std::size_t> first_distances_;  // of each view in distances_, and their number
    std::vector<double> pixel_values_;          // pixel by pixel
    Grid2D<Node> nodes_;
    std::vector<double> node_values_;
    std::vector<double> floor_;  // per band: what dark light is compared with [W m^-2 sr^-1]
    std::vector<double> interpolated_, integrated_;
};

}  // namespace uw
