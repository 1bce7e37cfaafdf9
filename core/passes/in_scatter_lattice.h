#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/image/film.h"
#include "core/light/integrator.h"
#include "core/light/lamp.h"
#include "core/light/medium.h"
#include "core/passes/pixel_view.h"

namespace uw {

/// A rectangle of the image [pixels].
struct ImageRectangle {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// The beams of lamps as narrow things in an image, such as a laser's line: rays that are some
/// pixels apart may pass them on both sides.
class FineBeams {
  public:
    /// `rays` must outlive this object.
    FineBeams(const RaySource& rays, const std::vector<Lamp>& emitters);

    /// From here on, has_any() is asked for parts of `area` and for this `width` at most.
    void begin(const ImageRectangle& area, double width, double reach);

    /// Whether a beam that is narrower than `width` pixels there is seen in `area`, or may be, up
    /// to the distance `reach` of begin() [m].
    bool has_any(const ImageRectangle& area, double width) const;

  private:
    /// Where the intensity is more than half of the greatest, and where it matters.
    struct Beam {
        Point3 apex;
        Vector3 axis;                    // unit
        double core_slope, outer_slope;  // tangents of the angles from the axis
    };
    /// The rays of a rectangle.
    struct Bundle {
        Point3 origin;
        Vector3 direction;                // of the ray in the middle
        std::array<Vector3, 4> outwards;  // normals of its sides
        std::array<double, 4> offsets;    // inside: dot(outwards, x) <= offset
        double pixel = 0;                 // width of a pixel, per metre of distance
    };

    static std::optional<Beam> beam_of(const Lamp& emitter);
    std::optional<Bundle> bundle(const ImageRectangle& area) const;
    bool is_fine_in(const Bundle& bundle, const Beam& beam, double width) const;

    const RaySource& rays_;
    std::vector<Beam> beams_;
    std::vector<const Beam*> near_;  // those of begin()
    double reach_ = 0;
};

/// Clouds of particles that are small in an image: rays that are some pixels apart may pass beside
/// them. Probes are finer: rays k_spacing pixels apart, or twice that in an even haze, of which
/// only the particles are known.
class FineParticles {
  public:
    static constexpr int k_spacing = 2;  // [pixels]

    /// Both must outlive this object.
    FineParticles(const RaySource& rays, const LitScene& scene);

    /// The probes of a tile are traced up to `reach` [m], once they are asked for. `edge`: of its
    /// squares, which are whole beyond the image's edge [pixels].
    void begin(const PixelWindow& tile, int edge, double reach);

    /// Whether the square of `size` pixels at (i, j) of the tile holds particles that rays at
    /// multiples of `spacing` in it do not tell of, by interpolation between them. All of them are
    /// multiples of k_spacing.
    bool has_any(int i, int j, int size, int spacing);

  private:
    /// Pixels of the tile.
    struct Square {
        int x, y, width, height;
    };

    double taken(int i, int j);
    Interval range(const Square& square, int step);
    // Whether a probe is farther than `allowed` from interpolation between rays `spacing` apart.
    bool differs(const Square& square, int step, int spacing, double allowed);

    const RaySource& rays_;
    const ConcentrationField* field_;
    AttenuationTable attenuation_;
    double reach_ = 0;
    PixelWindow tile_;
    // Shares of light that particles take away, at probes, mean over the bands; < 0: not yet known.
    Grid2D<double> taken_;
    std::vector<double> column_;
};

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
    /// used. `beside`: what is added to these values in each pixel, at least, by band; the
    /// tolerance is of both.
    void evaluate(const PixelWindow& tile, const Grid2D<PixelView>& views,
                  std::span<const double> beside);
    /// The least value of the tile's pixels by band, over all groups.
    void find_least(std::span<double> least) const;

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
    std::vector<double> floor_;   // per band: least reference for errors [W m^-2 sr^-1]
    std::vector<double> beside_;  // per band
    std::vector<double> interpolated_, integrated_;
};

}  // namespace uw
