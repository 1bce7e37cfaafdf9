#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray_source.h"
#include "core/frame/fine_beams.h"
#include "core/frame/fine_particles.h"
#include "core/frame/pixel_view.h"
#include "core/frame/ray_in_scatter.h"
#include "core/image/film.h"

namespace uw {

/// In-scatter of a tile of pixels. It varies smoothly across the image except at the edges of
/// shadows and surfaces, so it is integrated at the nodes of a lattice and interpolated between
/// them, bilinearly over the image and by a parabola over distance, where the nodes of the next
/// finer lattice confirm the interpolation; elsewhere the lattice is refined, down to single
/// pixels. Reused between tiles.
class InScatterLattice {
  public:
    /// Pixels along a tile's edge. Tiles are aligned to multiples of it in the full image, so that
    /// a window holds the same pixels as the whole image.
    static constexpr int k_tile = 32;

    /// `tolerance`: largest permitted relative difference, halfway between the nodes of the
    /// coarsest lattice, between the interpolated value and that integrated there; sqrt(2) times
    /// that for the next finer lattice, and so on. Pixels are interpolated from the halfway nodes
    /// as well, so their error is smaller. All references must outlive this object.
    InScatterLattice(const RaySource& rays, const LitScene& scene, const RayInScatter& in_scatter,
                     double tolerance);

    /// Computes the in-scatter of the pixels of `tile` (k_tile along an edge, less at the image's
    /// right and bottom). `views`, those of these pixels, must stay valid while the values are
    /// used.
    void evaluate(const PixelWindow& tile, const Grid2D<PixelView>& views);

    /// The values (RayInScatter) of one pixel of the tile, by its index in `views`; zeros where no
    /// ray enters the water.
    std::span<const double> values(std::size_t pixel) const {
        return std::span(pixel_values_).subspan(pixel * value_count_, value_count_);
    }

  private:
    static constexpr int k_coarsest = 32, k_finest = 2;  // spacings of the lattices [pixels]
    static constexpr int k_side = k_tile / k_finest + 1;
    static constexpr std::size_t k_stops = 3;   // distances of a parabola
    static constexpr std::size_t k_depths = 3;  // at most, of surfaces around a node

    /// A range of distances narrow enough that a parabola through its least, greatest and middle
    /// one gives the in-scatter up to any of them.
    struct Depth {
        double least = 0, greatest = 0;
        bool alike() const { return greatest <= (1 + 1e-9) * least; }
        std::size_t stops() const { return alike() ? 1 : k_stops; }
        double middle() const { return 0.5 * (least + greatest); }
    };
    /// A ray of the lattice.
    struct Node {
        enum class State { unknown, ready, unusable } state = State::unknown;
        int reach = 0;  // radius within which its depths hold [pixels]
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
    // Whether interpolation between the cell's corners agrees with integration at the nodes halfway
    // between them.
    bool confirmed(int i, int j, int spacing);
    // Its pixels, those of all its nodes in the tile included.
    ImageRectangle cell(int i, int j, int spacing) const;
    // Whether these nodes may miss something between them.
    bool has_fine(int i, int j, int spacing);
    bool agree(const Corners& from, const Place& place, const Node& node, double allowed);
    void collect_distances();
    void fill_cell(int i, int j, int spacing);
    void fill_pixel(int x, int y, int spacing);
    void set_floor();
    // False if one of the distances lies outside all depths of the node.
    bool add_node(const Node& node, double weight, std::span<const double> distances,
                  std::span<const double> weights, std::span<double> values) const;

    const RaySource& rays_;
    const RayInScatter& in_scatter_;
    double tolerance_;
    double distance_reach_;
    std::size_t value_count_;

    FineBeams beams_;
    FineParticles particles_;
    PixelWindow tile_;
    const Grid2D<PixelView>* views_ = nullptr;
    std::vector<double> distances_;             // of all views, one after another
    std::vector<std::size_t> first_distances_;  // index in distances_ for each view, then the total
    std::vector<double> pixel_values_;          // pixel by pixel
    Grid2D<Node> nodes_;
    std::vector<double> node_values_;
    std::vector<double> floor_;  // per band: least reference for errors [W m^-2 sr^-1]
    std::vector<double> interpolated_, integrated_;
};

}  // namespace uw
