#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/ray_source.h"
#include "core/frame/pixel_view.h"
#include "core/frame/ray_in_scatter.h"
#include "core/image/film.h"

namespace uw {

/// In-scatter of a tile of pixels. Seen from pixel to pixel it is smooth but at the edges of
/// shadows and surfaces: it is gathered at the nodes of a lattice and mixed between them, bilinear
/// over the image and by a parabola over distance, where the nodes of the next finer lattice
/// confirm that; elsewhere the lattice is refined, down to every pixel. Reused between tiles.
class InScatterLattice {
  public:
    /// Pixels along a tile's edge. Tiles lie at multiples of it in the full image, so that a window
    /// of an image holds what the whole image does.
    static constexpr int k_tile = 32;

    /// `tolerance`: largest relative difference allowed between the mixture and what a node says
    /// halfway between its neighbours, of the coarsest lattice; twice that of the next finer one,
    /// and so on. What is mixed from the halfway nodes too is closer.
    /// All references outlive this.
    InScatterLattice(const RaySource& rays, const RayInScatter& water, double tolerance);

    /// Gathers the water of the pixels of `tile` (k_tile along an edge, less at the image's right
    /// and bottom), whose views are given row by row.
    void gather(const PixelWindow& tile, std::span<const PixelView> views);

    /// The row (RayInScatter) of one pixel of the tile, by its index among the views; zeros where
    /// no ray enters the water.
    std::span<const double> row(std::size_t pixel) const {
        return std::span(rows_).subspan(pixel * row_size_, row_size_);
    }

  private:
    static constexpr int k_coarsest = 16, k_finest = 2;  // spacings of the lattices [pixels]
    static constexpr int k_side = k_tile / k_finest + 1;
    static constexpr std::size_t k_stops = 3;   // distances of a parabola
    static constexpr std::size_t k_depths = 3;  // surfaces at most that a node looks past

    /// Distances so much alike that a parabola through the nearest, the farthest and the middle
    /// tells the light up to any of them.
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
        std::size_t rows = 0;  // index in node_rows_ of the first stop of the first depth
    };
    using Corners = std::array<const Node*, 4>;
    struct Place;

    const Node& node(int i, int j);
    void find_depths(int i, int j, Node& node) const;
    bool include(double end, Node& node) const;
    bool gather_node(int i, int j, Node& node);
    // The four nodes around the cell at (i, j), none if one of them cannot be used there.
    bool corners(int i, int j, int spacing, Corners& found);
    // Whether the cell's corners say the same as the nodes halfway between them.
    bool confirmed(int i, int j, int spacing);
    bool agree(const Corners& from, const Place& place, const Node& node, double allowed);
    void collect_ends();
    void fill_cell(int i, int j, int spacing);
    void fill_pixel(int x, int y, int spacing);
    void set_floor();
    // False if the node knows no depth like one of the ends.
    bool add(const Node& node, double weight, std::span<const double> ends,
             std::span<const double> shares, std::span<double> row) const;
    const PixelView* view(int x, int y) const;

    const RaySource& rays_;
    const RayInScatter& water_;
    double tolerance_;
    double distance_reach_;
    std::size_t row_size_;

    PixelWindow tile_;
    std::span<const PixelView> views_;
    std::vector<double> ends_;             // of all views, one after another
    std::vector<std::size_t> first_ends_;  // of each view in ends_, and their number
    std::vector<double> rows_;             // of pixels
    std::vector<Node> nodes_;
    std::vector<double> node_rows_;
    std::vector<double> floor_;  // per band: what dark light is compared with [W m^-2 sr^-1]
    std::vector<double> mixed_, own_;
};

}  // namespace uw
